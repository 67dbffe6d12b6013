#include "importers/shared/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <fmt/format.h>

#include "description/camera.h"
#include "importers/shared/placement.h"

namespace abbe::importers {

namespace {

// World direction of a camera axis: 0 right, 1 up, 2 forward.
Imath::V3d axis(const ImportedCamera& camera, int row) {
  const Imath::M44d& m = camera.to_world;
  return {m[row][0], m[row][1], m[row][2]};
}

// Converts lens radius and focus distance from camera space to world units.
ImportedCamera in_world_units(ImportedCamera camera) {
  camera.lens_radius *= axis(camera, 1).length();
  camera.focus_distance *= axis(camera, 2).length();
  return camera;
}

void note_uneven_scale(const ImportedCamera& camera, SceneImporter& importer) {
  constexpr double kRelativeTolerance = 1e-3;  // Tolerance for numbers written with a few digits.
  const double forward = axis(camera, 2).length();
  for (const int across : {0, 1})
    if (std::abs(axis(camera, across).length() - forward) > kRelativeTolerance * forward)
      return importer.note(
          camera.where, "a non-uniform scale of the camera is not supported: its picture is not stretched");
}

// Notes that pictures darken towards the corners: source renderers record radiance, Abbe's sensors
// irradiance, which falls by cos^4 of the angle to the axis. Spectral-band sensors record radiance in both.
void note_vignetting(const ImportedCamera& camera, SceneImporter& importer) {
  constexpr double kNegligible = 0.9;
  if (std::holds_alternative<spec::Bins>(importer.scene.sensor->counts)) return;
  const auto width = static_cast<double>(camera.resolution[0]);
  const auto height = static_cast<double>(camera.resolution[1]);
  const double corner =
      std::tan(camera.fov_deg * std::numbers::pi / 360) * std::hypot(width, height) / std::min(width, height);
  const double relative_illuminance = 1 / std::pow(1 + corner * corner, 2);
  if (relative_illuminance < kNegligible)
    importer.note(camera.where,
                  fmt::format("the picture darkens towards its corners by cos^4 of the angle to the axis, to "
                              "{:.2g} of its center: that of the source renderer does not",
                              relative_illuminance));
}

// Distance of the film from the lens: 2 r N for the lens radius r and the default f-number N. In the source
// renderer, brightness does not depend on lens radius or film size. At this distance the exposure equals that
// of the pinhole camera.
double film_distance_of(const ImportedCamera& camera) {
  return 2 * camera.lens_radius * description::kDefaultFNumber;
}

// Pixel pitch [um] for which that film has the field of view.
double pixel_pitch_um(const ImportedCamera& camera) {
  const auto pixels = static_cast<double>(std::min(camera.resolution[0], camera.resolution[1]));
  const double half_film = film_distance_of(camera) * std::tan(camera.fov_deg * std::numbers::pi / 360);
  return 2 * half_film / pixels * 1e6;
}

// Largest lens radius r for which the lens is f/0.5 or slower. With the film at v = 8 r and the focus at s, N
// = f/(2 r) = 4/(1 + 8 r/s).
double largest_radius(const ImportedCamera& camera) {
  constexpr double n = description::kDefaultFNumber;
  return camera.focus_distance * (n / description::kFastestFNumber - 1) / (2 * n);
}

void limit_radius(ImportedCamera& camera, SceneImporter& importer) {
  const double largest = largest_radius(camera);
  if (!(camera.lens_radius > largest)) return;
  importer.note(camera.where,
                fmt::format("the lens is too wide for its focus distance: its radius is {:.4g}, not {:.4g}",
                            largest, camera.lens_radius));
  camera.lens_radius = largest;
}

// The thin lens; its focal length follows from the distances of film and focus.
spec::ThinLens lens_of(const ImportedCamera& camera) {
  const double film_distance = film_distance_of(camera);
  spec::ThinLens lens;
  lens.focal_length = 1 / (1 / camera.focus_distance + 1 / film_distance);
  lens.aperture.f_number =
      std::max(lens.focal_length / (2 * camera.lens_radius), description::kFastestFNumber);
  lens.focus_distance = camera.focus_distance;
  lens.where = camera.where;
  return lens;
}

}  // namespace

Imath::M44d world_mirror_of(const Imath::M44d& camera_to_world, const SourcePosition& where,
                            SceneImporter& importer) {
  // Axes x right, y up, z forward are left-handed if the picture is not mirrored.
  if (mirrors(camera_to_world)) return {};
  importer.note(where, "the camera shows a mirror image of right-handed space: x is negated");
  return scaling({-1, 1, 1});
}

void set_camera(const ImportedCamera& given, SceneImporter& importer) {
  ImportedCamera camera = in_world_units(given);
  const Imath::M44d& m = camera.to_world;
  const Imath::V3d from(m[3][0], m[3][1], m[3][2]);
  const Imath::V3d forward = axis(camera, 2).normalized();
  const Imath::V3d up = axis(camera, 1).normalized();
  note_uneven_scale(camera, importer);
  if (!importer.scene.sensor) importer.scene.sensor.emplace();
  note_vignetting(camera, importer);
  importer.scene.sensor->resolution = {{camera.resolution}, camera.where};
  const spec::View view{from, from + forward, up, 0};
  spec::Camera& camera_spec = importer.scene.camera.emplace();
  camera_spec.where = camera.where;
  if (camera.lens_radius > 0 && camera.focus_distance > 0) {
    limit_radius(camera, importer);
    importer.scene.sensor->pixel_pitch_um = pixel_pitch_um(camera);
    camera_spec.kind = spec::ThinLensCamera{lens_of(camera), view};
    return;
  }
  spec::PinholeCamera pinhole{{}, view};
  pinhole.lens.view = spec::FieldOfView{{camera.fov_deg}};
  camera_spec.kind = pinhole;
}

}  // namespace abbe::importers

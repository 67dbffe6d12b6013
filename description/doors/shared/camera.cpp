#include "description/doors/shared/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <fmt/format.h>

#include "description/camera.h"
#include "description/doors/shared/placement.h"

namespace abbe::doors {

namespace {

// What an axis of the camera is in the world: to the right, up, or where it looks.
Imath::V3d axis(const GivenCamera& camera, int row) {
  const Imath::M44d& m = camera.to_world;
  return {m[row][0], m[row][1], m[row][2]};
}

// Its lens and its focus are told in coordinates of its own.
GivenCamera in_world(GivenCamera camera) {
  camera.lens_radius *= axis(camera, 1).length();
  camera.focus_distance *= axis(camera, 2).length();
  return camera;
}

void note_uneven_scale(const GivenCamera& camera, Door& door) {
  constexpr double kAlike = 1e-3;  // what numbers written to a few digits are
  const double onwards = axis(camera, 2).length();
  for (const int across : {0, 1})
    if (std::abs(axis(camera, across).length() - onwards) > kAlike * onwards)
      return door.note(
          camera.where,
          "a camera that is scaled unevenly has no counterpart here: its picture is not stretched");
}

// There pixels tell the radiance that comes to them, here the irradiance of the film, unless it holds
// radiances: by cos^4 of the angle to the axis less of these.
void note_dark_corners(const GivenCamera& camera, Door& door) {
  constexpr double kAlike = 0.9;
  if (std::holds_alternative<spec::Bins>(door.scene.sensor->counts)) return;
  const auto width = static_cast<double>(camera.resolution[0]);
  const auto height = static_cast<double>(camera.resolution[1]);
  const double corner =
      std::tan(camera.fov_deg * std::numbers::pi / 360) * std::hypot(width, height) / std::min(width, height);
  const double share = 1 / std::pow(1 + corner * corner, 2);
  if (share < kAlike)
    door.note(camera.where,
              fmt::format("a picture darkens towards its corners here, by cos^4 of the angle to the axis as "
                          "behind lenses, to {:.2g} of its middle: those of perspective cameras there do not",
                          share));
}

// Brightness does not depend on the opening of the other renderer's lens, nor on the size of its film. So its
// film is where the lens of that opening exposes as the pinhole does, which alone leaves brightness as it is.
double film_distance_of(const GivenCamera& camera) {
  return 2 * camera.lens_radius * description::kDefaultFNumber;
}

// The distance of pixels that makes the view that wide on a film there [um].
double pixel_pitch_um(const GivenCamera& camera) {
  const auto pixels = static_cast<double>(std::min(camera.resolution[0], camera.resolution[1]));
  const double half_film = film_distance_of(camera) * std::tan(camera.fov_deg * std::numbers::pi / 360);
  return 2 * half_film / pixels * 1e6;
}

// The largest opening that keeps the lens at f/0.5 or slower: with the film at v = 8 r and the focus at s,
// N = f/(2 r) = 4/(1 + 8 r/s) for the radius r.
double largest_radius(const GivenCamera& camera) {
  constexpr double n = description::kDefaultFNumber;
  return camera.focus_distance * (n / description::kFastestFNumber - 1) / (2 * n);
}

void limit_radius(GivenCamera& camera, Door& door) {
  const double largest = largest_radius(camera);
  if (!(camera.lens_radius > largest)) return;
  door.note(camera.where,
            fmt::format("no lens in air is so wide for its focus: its radius is {:.4g}, not {:.4g}", largest,
                        camera.lens_radius));
  camera.lens_radius = largest;
}

// The lens of that opening before that film: its focal length follows from the distances of film and focus.
spec::ThinLens lens_of(const GivenCamera& camera) {
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

Imath::M44d upright_world(const Imath::M44d& camera_to_world) {
  // x to the right, y up and z onwards are left-handed where the picture is not mirrored.
  return mirrors(camera_to_world) ? Imath::M44d() : scaling({-1, 1, 1});
}

void set_camera(const GivenCamera& given, Door& door) {
  GivenCamera camera = in_world(given);
  const Imath::M44d& m = camera.to_world;
  const Imath::V3d from(m[3][0], m[3][1], m[3][2]);
  const Imath::V3d onwards = axis(camera, 2).normalized();
  const Imath::V3d up = axis(camera, 1).normalized();
  note_uneven_scale(camera, door);
  if (!door.scene.sensor) door.scene.sensor.emplace();
  note_dark_corners(camera, door);
  door.scene.sensor->resolution = {{camera.resolution}, camera.where};
  const spec::View view{from, from + onwards, up, 0};
  spec::Camera& said = door.scene.camera.emplace();
  said.where = camera.where;
  if (camera.lens_radius > 0 && camera.focus_distance > 0) {
    limit_radius(camera, door);
    door.scene.sensor->pixel_pitch_um = pixel_pitch_um(camera);
    said.kind = spec::ThinLensCamera{lens_of(camera), view};
    return;
  }
  spec::PinholeCamera pinhole{{}, view};
  pinhole.lens.view = spec::FieldOfView{{camera.fov_deg}};
  said.kind = pinhole;
}

}  // namespace abbe::doors

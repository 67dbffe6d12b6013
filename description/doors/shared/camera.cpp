#include "description/doors/shared/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "description/camera.h"
#include "description/doors/shared/placement.h"

namespace abbe::doors {

namespace {

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

// The lens of that opening before that film: its focal length follows from the distances of film and focus.
spec::ThinLens lens_of(const GivenCamera& camera) {
  const double film_distance = film_distance_of(camera);
  spec::ThinLens lens;
  lens.focal_length = 1 / (1 / camera.focus_distance + 1 / film_distance);
  lens.aperture.f_number = lens.focal_length / (2 * camera.lens_radius);
  lens.focus_distance = camera.focus_distance;
  lens.where = camera.where;
  return lens;
}

}  // namespace

Imath::M44d upright_world(const Imath::M44d& camera_to_world) {
  // x to the right, y up and z onwards are left-handed where the picture is not mirrored.
  return mirrors(camera_to_world) ? Imath::M44d() : scaling({-1, 1, 1});
}

void set_camera(const GivenCamera& camera, Door& door) {
  const Imath::M44d& m = camera.to_world;
  const Imath::V3d from(m[3][0], m[3][1], m[3][2]);
  const Imath::V3d onwards = Imath::V3d(m[2][0], m[2][1], m[2][2]).normalized();
  const Imath::V3d up = Imath::V3d(m[1][0], m[1][1], m[1][2]).normalized();
  if (!door.scene.sensor) door.scene.sensor.emplace();
  door.scene.sensor->resolution = {{camera.resolution}, camera.where};
  const spec::View view{from, from + onwards, up, 0};
  spec::Camera& said = door.scene.camera.emplace();
  said.where = camera.where;
  if (camera.lens_radius > 0 && camera.focus_distance > 0) {
    door.scene.sensor->pixel_pitch_um = pixel_pitch_um(camera);
    said.kind = spec::ThinLensCamera{lens_of(camera), view};
    return;
  }
  spec::PinholeCamera pinhole{{}, view};
  pinhole.lens.view = spec::FieldOfView{{camera.fov_deg}};
  said.kind = pinhole;
}

}  // namespace abbe::doors

#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <ImathMatrix.h>

#include "description/doors/shared/door.h"

namespace abbe::doors {

/// A perspective camera of another renderer.
struct GivenCamera {
  Imath::M44d to_world;  ///< From x to the right of the picture, y up in it, z where it looks.
  double fov_deg = 90;   ///< Along the shorter axis of the picture.
  double lens_radius = 0;
  double focus_distance = 0;
  std::array<std::int64_t, 2> resolution{};
  SourcePosition where;
};

/// What everything in the other renderer's scene goes through, so that right hands stay right hands: nothing,
/// or where its camera sees what a mirror shows here, the mirror at x = 0.
[[nodiscard]] Imath::M44d upright_world(const Imath::M44d& camera_to_world);

/// Sets the scene's camera and its sensor's resolution; `to_world` is that of the scene to be written.
void set_camera(const GivenCamera& camera, Door& door);

}  // namespace abbe::doors

#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <ImathMatrix.h>

#include "description/importers/shared/scene_importer.h"

namespace abbe::importers {

/// A perspective camera of the source scene.
struct ImportedCamera {
  Imath::M44d to_world;  ///< From camera space: x right in the picture, y up, z along the view.
  double fov_deg = 90;   ///< Field of view along the shorter axis of the picture.
  double lens_radius = 0;
  double focus_distance = 0;
  std::array<std::int64_t, 2> resolution{};
  SourcePosition where;
};

/// Transform applied to all objects of the source scene to keep right-handed coordinates. It is the identity
/// or, if the source camera shows a mirror image of what Abbe's camera would show, the reflection at x = 0.
[[nodiscard]] Imath::M44d world_mirror_of(const Imath::M44d& camera_to_world);

/// Sets the camera and the sensor's resolution. `to_world` of `camera` leads to the written scene's
/// coordinates.
void set_camera(const ImportedCamera& camera, SceneImporter& importer);

}  // namespace abbe::importers

#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <ImathMatrix.h>

#include "importers/shared/scene_importer.h"

namespace abbe::importers {

/// A perspective camera of the source scene.
struct ImportedCamera {
  /// Camera-to-world matrix for row vectors. Camera space has x right in the picture, y up and z along the
  /// view. A scale is allowed; it also scales `lens_radius` and `focus_distance`.
  Imath::M44d to_world;
  double fov_deg = 90;        ///< Full field of view along the shorter axis of the picture, in (0, 180).
  double lens_radius = 0;     ///< Radius of a thin lens in camera space; 0 for a pinhole.
  double focus_distance = 0;  ///< Distance in camera space from the lens to the plane in focus.
  std::array<std::int64_t, 2> resolution{};  ///< Width and height [px], both at least 1.
  SourcePosition where;
};

/// Transform that every object-to-world matrix of the source scene is followed by. It is the reflection x ->
/// -x if the source camera shows a mirror image of what Abbe's camera would show, which is noted at `where`.
/// Otherwise it is the identity. `camera_to_world` has the axes of `ImportedCamera::to_world`.
[[nodiscard]] Imath::M44d world_mirror_of(const Imath::M44d& camera_to_world, const SourcePosition& where,
                                          SceneImporter& importer);

/// Sets the camera of `importer.scene` and the resolution of its sensor, which is added if absent.
/// `camera.to_world` must already include the result of `world_mirror_of`. The camera is a thin lens if
/// `lens_radius` and `focus_distance` are positive; its film is set so that a pinhole would be as bright.
/// Otherwise it is a pinhole. Reports no errors. Notes:
/// - a non-uniform scale;
/// - a lens faster than f/0.5, whose radius is reduced;
/// - a picture that darkens towards its corners.
void set_camera(const ImportedCamera& camera, SceneImporter& importer);

}  // namespace abbe::importers

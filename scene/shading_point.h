#pragma once

#include <ImathVec.h>

#include "scene/scene.h"
#include "scene/shapes/ray.h"

namespace abbe {

/// Shading frame of a hit, in render coordinates, and its texture coordinates. The frame's z axis is the
/// outward normal, as modified by vertex normals and by a relief: a normal or bump map.
struct ShadingPoint {
  Basis<float> frame;
  Imath::V2f uv{0, 0};  ///< As `SurfaceCoordinates::uv`.
  bool relief = false;  ///< True if z may differ from the geometric normal.
};

/// Shading point of a hit at that time, a fraction of the exposure, for scenes with `features.textures`;
/// elsewhere the geometric normal suffices. Vertex normals apply first, then a relief. If the material needs
/// texture coordinates, they are computed and the x axis runs along dp/du, made perpendicular to z. Otherwise
/// they are (0, 0) and the x axis is arbitrary.
[[nodiscard]] ShadingPoint textured_shading_point(const Scene& scene, const SurfaceHit& hit, float time);

}  // namespace abbe

#pragma once

#include <vector>

#include <ImathVec.h>

#include "scene/shapes/shape.h"

namespace abbe {

/// Viewing direction of a drawing, given by the unit vectors that point right and up in it. They are
/// perpendicular.
struct DrawingPlane {
  Imath::V3d right;
  Imath::V3d up;
};

/// Outline of a shape viewed from far away, as polylines in space: the circumference of spheres and discs,
/// the edges of quads, and the creases of meshes. A mesh with too many faces for a drawing is replaced by its
/// bounding box.
[[nodiscard]] std::vector<std::vector<Imath::V3d>> outline(const Shape& shape, const DrawingPlane& plane);

}  // namespace abbe

#pragma once

#include <vector>

#include <ImathVec.h>

#include "scene/shapes/shape.h"

namespace abbe {

/// Viewing direction of a drawing, given by the perpendicular unit vectors that point right and up in it.
struct DrawingPlane {
  Imath::V3d right;
  Imath::V3d up;
};

/// Outline of a shape viewed from far away, as polylines in space [m], at time 0. It consists of the
/// circumference of spheres and discs, the edges of quads, and the creases of meshes. Creases are edges of
/// one triangle, or of two whose normals differ by more than one degree. Closed lines repeat their first
/// point. A mesh of more than 4000 triangles is replaced by the rectangle around its bounding box in the
/// drawing.
[[nodiscard]] std::vector<std::vector<Imath::V3d>> outline(const Shape& shape, const DrawingPlane& plane);

}  // namespace abbe

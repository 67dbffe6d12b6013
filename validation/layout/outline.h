#pragma once

#include <vector>

#include <ImathVec.h>

#include "scene/shapes/shape.h"

namespace abbe {

/// A direction of sight, by what points right and what points up in its drawing: unit and across each other.
struct DrawingPlane {
  Imath::V3d right;
  Imath::V3d up;
};

/// What a shape looks like from far away, as lines through points of space: the circumference of spheres and
/// discs, the edges of quads and those of meshes at which their faces bend. Of a mesh of more faces than a
/// drawing can show, the box around it.
[[nodiscard]] std::vector<std::vector<Imath::V3d>> outline(const Shape& shape, const DrawingPlane& plane);

}  // namespace abbe

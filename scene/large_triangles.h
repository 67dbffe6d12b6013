#pragma once

#include <cstddef>
#include <vector>

#include "scene/faces.h"
#include "scene/shapes/shape_instance.h"
#include "scene/shapes/triangles.h"

namespace abbe {

/// True if Embree may miss triangles of `set` for rays that start just in front of them, where another shape
/// comes near. `set` represents shape number `shape` of `shapes`. Embree's floats resolve the origin of a ray
/// to a fraction of a triangle's size, unless the triangle is parallel to two axes. Near the scene's origin,
/// rays start closer to surfaces than that. False for sets of more than 64 triangles. Most of them are so
/// small that only a spot around the origin is affected.
[[nodiscard]] bool needs_double_precision(const TriangleSet& set, std::size_t shape,
                                          const std::vector<ShapeInstance>& shapes, FaceFinder& faces);

}  // namespace abbe

#pragma once

#include <cstddef>
#include <vector>

#include "scene/faces.h"
#include "scene/shapes/shape_instance.h"
#include "scene/shapes/triangles.h"

namespace abbe {

/// Whether Embree may miss triangles of a shape, of that number and made of that set, from just in front
/// where another shape comes near: its floats tell where a ray starts by some share of a triangle's size,
/// unless that lies along two axes, and near the origin rays start off surfaces by less. Of sets of more than
/// 64 it is never said: most of such triangles are so small that it matters on a spot around the origin
/// alone.
[[nodiscard]] bool outgrows_floats(const TriangleSet& set, std::size_t shape,
                                   const std::vector<ShapeInstance>& shapes, FaceFinder& faces);

}  // namespace abbe

#include "scene/large_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace abbe {
namespace {

// The region where Embree may miss a triangle for a ray that starts just in front of it; empty if there is
// none.
Imath::Box3d imprecise_region(const std::array<Imath::V3d, 3>& corners) {
  constexpr double kTimesLarger = 16;
  Imath::Box3d box;
  for (const Imath::V3d& corner : corners) box.extendBy(corner);
  const Imath::V3d size = box.size();
  const double slack = size.length() / kTimesLarger;
  const Imath::V3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  Imath::Box3d part;
  if (std::min({size.x, size.y, size.z}) == 0 || std::abs(corners[0].dot(normal)) > slack) return part;
  for (int axis = 0; axis < 3; ++axis) {
    part.min[axis] = std::max(box.min[axis], -slack);
    part.max[axis] = std::min(box.max[axis], slack);
  }
  return part;
}

bool comes_near(const Shape& shape, const Imath::Box3d& part, FaceFinder& faces) {
  if (!part.intersects(bounds(shape))) return false;
  return motion_of(shape) != nullptr || !has_faces(shape) || !faces.near(shape, part).empty();
}

}  // namespace

bool needs_double_precision(const TriangleSet& set, std::size_t shape,
                            const std::vector<ShapeInstance>& shapes, FaceFinder& faces) {
  constexpr std::size_t kMaxTriangles = 64;
  if (set.triangles.size() > kMaxTriangles) return false;
  return std::ranges::any_of(set.triangles, [&](const auto& triangle) {
    const auto& [a, b, c] = triangle;
    const Imath::Box3d region = imprecise_region(
        {Imath::V3d(set.vertices[a]), Imath::V3d(set.vertices[b]), Imath::V3d(set.vertices[c])});
    if (region.isEmpty()) return false;
    for (std::size_t other = 0; other < shapes.size(); ++other)
      if (other != shape && comes_near(shapes[other].shape, region, faces)) return true;
    return false;
  });
}

}  // namespace abbe

#include "scene/large_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace abbe {
namespace {

// Where Embree may miss a triangle that a ray starts just in front of; empty where it does not.
Imath::Box3d vague_part(const std::array<Imath::V3d, 3>& corners) {
  constexpr double kTimesLarger = 16;
  Imath::Box3d box;
  for (const Imath::V3d& corner : corners) box.extendBy(corner);
  const Imath::V3d size = box.size();
  const double reach = size.length() / kTimesLarger;
  const Imath::V3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  Imath::Box3d part;
  if (std::min({size.x, size.y, size.z}) == 0 || std::abs(corners[0].dot(normal)) > reach) return part;
  for (int axis = 0; axis < 3; ++axis) {
    part.min[axis] = std::max(box.min[axis], -reach);
    part.max[axis] = std::min(box.max[axis], reach);
  }
  return part;
}

bool comes_near(const Shape& shape, const Imath::Box3d& part, FaceFinder& faces) {
  if (!part.intersects(bounds(shape))) return false;
  return motion_of(shape) != nullptr || !has_faces(shape) || !faces.near(shape, part).empty();
}

}  // namespace

bool outgrows_floats(const TriangleSet& set, std::size_t shape, const std::vector<ShapeInstance>& shapes,
                     FaceFinder& faces) {
  constexpr std::size_t kMost = 64;
  if (set.triangles.size() > kMost) return false;
  return std::ranges::any_of(set.triangles, [&](const auto& triangle) {
    const auto& [a, b, c] = triangle;
    const Imath::Box3d vague =
        vague_part({Imath::V3d(set.vertices[a]), Imath::V3d(set.vertices[b]), Imath::V3d(set.vertices[c])});
    if (vague.isEmpty()) return false;
    for (std::size_t other = 0; other < shapes.size(); ++other)
      if (other != shape && comes_near(shapes[other].shape, vague, faces)) return true;
    return false;
  });
}

}  // namespace abbe

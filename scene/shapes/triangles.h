#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/shapes/shape.h"

namespace abbe {

/// What is rendered as triangles, in float as Embree sees them.
struct TriangleSet {
  std::vector<Imath::V3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Imath::V3f> normals;  ///< Per triangle, from the unrounded vertices; none in a prototype.
  bool is_quad = false;             ///< Its triangles are the halves of a parallelogram.
};

[[nodiscard]] TriangleSet triangles_of(const Mesh& mesh);
[[nodiscard]] TriangleSet triangles_of(const Quad& quad);
/// Unit normal of a triangle of a mesh or quad, from the unrounded vertices.
[[nodiscard]] Imath::V3d triangle_normal(const PlainShape& shape, std::size_t triangle);
/// The triangles of a mesh or quad with their normals.
[[nodiscard]] TriangleSet with_normals(const Mesh& mesh);
[[nodiscard]] TriangleSet with_normals(const Quad& quad);

/// Where a ray crosses the plane of a triangle, in its lengths; NaN or infinite when it does not.
[[nodiscard]] inline double plane_crossing(const TriangleSet& set, std::uint32_t triangle,
                                           const BasicRay<double>& ray) {
  const auto& [a, b, c] = set.triangles[triangle];
  const Imath::V3d origin(set.vertices[a]);
  const Imath::V3d normal =
      (Imath::V3d(set.vertices[b]) - origin).cross(Imath::V3d(set.vertices[c]) - origin);
  return (origin - ray.origin).dot(normal) / ray.direction.dot(normal);
}

[[nodiscard]] std::size_t memory_bytes_of(const TriangleSet& set);

/// How a point of a triangle is to be moved within it to be `clear` of its edges, as far as that goes:
/// nowhere, unless it is nearer. Beside an edge rounding may put a point beyond the other face that ends
/// there, and a path that goes on from it would have left a closed mesh. The diagonal of a quad is no edge:
/// beside it Embree takes the one half for the other, as far off as floats tell places on a large quad apart.
[[nodiscard]] Imath::V3d shift_off_edges(const TriangleSet& set, std::uint32_t triangle,
                                         const Imath::V3d& point, double clear);

}  // namespace abbe

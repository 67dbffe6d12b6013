#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/shapes/shape.h"

namespace abbe {

/// Triangles that represent a mesh or quad, in float as Embree uses them, in the coordinates of the shape
/// [m].
struct TriangleSet {
  std::vector<Imath::V3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Outward unit normals, one per triangle, from the unrounded vertices; empty in a prototype.
  std::vector<Imath::V3f> normals;
  bool is_quad = false;  ///< True if the two triangles are halves of a parallelogram.
};

/// The triangles of a mesh or quad without normals.
[[nodiscard]] TriangleSet triangles_of(const Mesh& mesh);
[[nodiscard]] TriangleSet triangles_of(const Quad& quad);
/// Outward unit normal of a triangle of a mesh or quad, from the unrounded vertices. Other shapes are not
/// allowed.
[[nodiscard]] Imath::V3d triangle_normal(const PlainShape& shape, std::size_t triangle);
/// The triangles of a mesh or quad with their normals.
[[nodiscard]] TriangleSet with_normals(const Mesh& mesh);
[[nodiscard]] TriangleSet with_normals(const Quad& quad);

/// Distance along a ray, in units of its direction, to the plane of a triangle; NaN or infinite if it is
/// parallel.
[[nodiscard]] inline double plane_crossing(const TriangleSet& set, std::uint32_t triangle,
                                           const BasicRay<double>& ray) {
  const auto& [a, b, c] = set.triangles[triangle];
  const Imath::V3d origin(set.vertices[a]);
  const Imath::V3d normal =
      (Imath::V3d(set.vertices[b]) - origin).cross(Imath::V3d(set.vertices[c]) - origin);
  return (origin - ray.origin).dot(normal) / ray.direction.dot(normal);
}

/// Memory in bytes of the lists.
[[nodiscard]] std::size_t memory_bytes_of(const TriangleSet& set);

/// Displacement that moves a point within its triangle to the distance `clear` from its edges, as far as
/// possible; zero if the point is farther. Near an edge, rounding may put a point behind the other face
/// there. A path that continues from it would have left a closed mesh. The diagonal of a quad does not count
/// as an edge. Near it Embree confuses the halves over distances that float resolution on a large quad
/// allows.
[[nodiscard]] Imath::V3d shift_off_edges(const TriangleSet& set, std::uint32_t triangle,
                                         const Imath::V3d& point, double clear);

}  // namespace abbe

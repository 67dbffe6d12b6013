#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "scene/shapes/model.h"

namespace abbe {

/// Triangles with shared vertices [m]. The winding determines the normals: counter-clockwise as viewed from
/// outside. Prisms become meshes too.
struct Mesh {
  std::vector<Imath::V3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices of vertices; nonzero area.
  /// Texture coordinates of the corners of each triangle; none, or as many as triangles.
  std::vector<std::array<Imath::V2f, 3>> coordinates = {};
  /// Unit vertex normals of each triangle: the normals of the smooth surface that it approximates. None, or
  /// as many as triangles.
  std::vector<std::array<Imath::V3f, 3>> normals = {};
  /// Triangles of zero area. No ray hits them, but adjacent triangles are connected through them.
  std::vector<std::array<std::uint32_t, 3>> slivers = {};
};

/// Nearest hit at t in (t_min, ray.t_max), in units of the ray's direction, by a test of every triangle,
/// edges included. It is exact but slow, for single rays. Triangles of zero area are never hit.
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Mesh& mesh, const BasicRay<T>& ray, T t_min);

/// Half the cross product of two edges: the outward unit normal times the area [m^2].
[[nodiscard]] Imath::V3d area_vector(const Mesh& mesh, std::size_t triangle);

/// Memory in bytes of the lists, without slivers.
[[nodiscard]] std::size_t memory_bytes(const Mesh& mesh);
/// Area of one side of all triangles [m^2].
[[nodiscard]] double area(const Mesh& mesh);
[[nodiscard]] Imath::Box3d bounds(const Mesh& mesh);
/// Cumulative fraction of the area over the triangles, ending in 1.
[[nodiscard]] std::vector<float> triangle_cdf(const Mesh& mesh);
/// Samples a point uniformly by area, by `u` in [0, 1)^2; `triangle_cdf` is that function's result for the
/// mesh.
[[nodiscard]] SurfacePoint sample_area(const Mesh& mesh, const std::vector<float>& triangle_cdf,
                                       Imath::V2f u);

[[nodiscard]] SurfaceCoordinates coordinates_on(const Mesh& mesh, const Imath::V3d& point,
                                                std::size_t triangle);
/// Volume [m^3] of the largest closed component, cavities included; 0 if there is none. A shape inside
/// another one has a smaller volume, unless the outer shape has further components.
[[nodiscard]] double enclosed_volume(const Mesh& mesh);
[[nodiscard]] bool may_intersect(const Mesh& mesh, const Imath::Box3d& box);
[[nodiscard]] OuterSide outer_side(const Mesh& mesh);
[[nodiscard]] Outline outline(const Mesh& mesh, const Imath::M44d& to_world, const DrawingPlane& plane);
void shift(Mesh& mesh, const Imath::V3d& by);
void transform(Mesh& mesh, const Imath::M44d& by, double scale);

/// A right prism with an isosceles cross-section. The apex angle [degrees], in (0, 180), is between its two
/// equal faces of width `side`. The apex edge points to +z, the third face is a plane z = const, and the
/// edges of length `length` run along y. The origin is the centroid. On the three faces the texture
/// coordinate u runs along the length and v around the prism, each from 0 to 1. On the ends they are
/// fractions of the cross-section's box.
[[nodiscard]] Mesh make_prism(double apex_deg, double side, double length);

/// Distance along a ray, in units of its direction, to its intersection with a triangle, edges included. It
/// may be negative; nothing if the ray misses. Solves o + t d = a + u (b - a) + v (c - a) by Cramer's rule.
/// [Moller1997]
template <typename T>
[[nodiscard]] std::optional<T> intersect_triangle(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b,
                                                  const Imath::Vec3<T>& c, const BasicRay<T>& ray) {
  const Imath::Vec3<T> e1 = b - a;
  const Imath::Vec3<T> e2 = c - a;
  const Imath::Vec3<T> s = ray.origin - a;
  const T determinant = ray.direction.cross(e2).dot(e1);
  if (determinant == 0) return std::nullopt;  // the ray is parallel to the plane, or the area is zero
  const T sign = std::copysign(T{1}, determinant);
  const T scale = std::abs(determinant);
  const T u = ray.direction.cross(e2).dot(s) * sign;  // scaled by the determinant, as is v
  const T v = s.cross(e1).dot(ray.direction) * sign;
  // Adjacent triangles overlap by the width of rounding, so that a ray through their common edge hits one of
  // them.
  const T magnitude = s.length() * ray.direction.length() * std::max(e1.length(), e2.length());
  const T slack = 8 * std::numeric_limits<T>::epsilon() * magnitude;
  if (!(u >= -slack && v >= -slack && u + v <= scale + slack)) return std::nullopt;
  return s.cross(e1).dot(e2) / determinant;
}

[[nodiscard]] TriangleSet triangles_of(const Mesh& mesh);
[[nodiscard]] Imath::V3d normal_at(const Mesh& mesh, std::size_t triangle);

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

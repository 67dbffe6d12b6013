#pragma once

#include <array>
#include <optional>

#include "scene/shapes/shape.h"

namespace abbe {

template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Quad& quad, const BasicRay<T>& ray, T t_min) {
  const Imath::Vec3<T> edge_u(quad.edge_u);
  const Imath::Vec3<T> edge_v(quad.edge_v);
  const Imath::Vec3<T> corner(quad.corner);
  const Imath::Vec3<T> normal = edge_u.cross(edge_v);
  const T t = (corner - ray.origin).dot(normal) / ray.direction.dot(normal);
  if (!(t > t_min && t < ray.t_max)) return std::nullopt;
  const Imath::Vec3<T> w = ray.origin + ray.direction * t - corner;
  const T u = w.cross(edge_v).dot(normal) / normal.length2();
  const T v = edge_u.cross(w).dot(normal) / normal.length2();
  if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return std::nullopt;
  return ShapeHit<T>{t, corner + edge_u * u + edge_v * v, normal.normalized()};
}

/// The corners at (u, v) = (0, 0), (1, 0), (0, 1), (1, 1), rounded to float.
[[nodiscard]] inline std::array<Imath::V3f, 4> corners(const Quad& quad) {
  const Imath::V3d& c = quad.corner;
  return {Imath::V3f(c), Imath::V3f(c + quad.edge_u), Imath::V3f(c + quad.edge_v),
          Imath::V3f(c + quad.edge_u + quad.edge_v)};
}

/// The two triangles a quad is rendered as, in indices of `corners`.
inline constexpr std::array<std::array<std::uint32_t, 3>, 2> kQuadTriangles{{{0, 1, 2}, {3, 2, 1}}};

/// The point at (u, v) on those triangles.
[[nodiscard]] inline Imath::V3d point_at(const Quad& quad, double u, double v) {
  const std::array<Imath::V3f, 4> c = corners(quad);
  const bool first = u + v <= 1;
  const Imath::V3d origin(first ? c[0] : c[3]);
  const Imath::V3d along_u = Imath::V3d(first ? c[1] : c[2]) - origin;
  const Imath::V3d along_v = Imath::V3d(first ? c[2] : c[1]) - origin;
  return origin + along_u * (first ? u : 1 - u) + along_v * (first ? v : 1 - v);
}

[[nodiscard]] inline Imath::V3d normal_of(const Quad& quad) {
  return quad.edge_u.cross(quad.edge_v).normalized();
}

[[nodiscard]] inline double area(const Quad& quad) {
  return quad.edge_u.cross(quad.edge_v).length();
}

[[nodiscard]] inline Imath::Box3d bounds(const Quad& quad) {
  Imath::Box3d box;
  for (const Imath::V3f& corner : corners(quad)) box.extendBy(Imath::V3d(corner));
  return box;
}

[[nodiscard]] inline SurfacePoint sample_area(const Quad& quad, Imath::V2f u) {
  return {Imath::V3f(point_at(quad, static_cast<double>(u.x), static_cast<double>(u.y))),
          Imath::V3f(normal_of(quad))};
}

}  // namespace abbe

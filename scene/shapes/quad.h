#pragma once

#include <array>
#include <optional>

#include "scene/shapes/shape.h"

namespace abbe {

/// Hit at t in (t_min, ray.t_max), on either side; t is in units of the ray's direction. The normal is that
/// of the quad, whatever the ray's direction. Nothing for a ray in the plane.
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Quad& quad, const BasicRay<T>& ray, T t_min) {
  const Imath::Vec3<T> edge_u(quad.edge_u);
  const Imath::Vec3<T> edge_v(quad.edge_v);
  const Imath::Vec3<T> corner(quad.corner);
  const Imath::Vec3<T> normal = edge_u.cross(edge_v);
  const T towards = ray.direction.dot(normal);
  if (towards == 0) return std::nullopt;
  const T t = (corner - ray.origin).dot(normal) / towards;
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

/// The two triangles that represent a quad, as indices of `corners`.
inline constexpr std::array<std::array<std::uint32_t, 3>, 2> kQuadTriangles{{{0, 1, 2}, {3, 2, 1}}};

/// Outward unit normal.
[[nodiscard]] inline Imath::V3d normal_of(const Quad& quad) {
  return quad.edge_u.cross(quad.edge_v).normalized();
}

/// A quad prepared for sampling: its halves are those two triangles, with corners rounded to float.
class RenderedQuad {
 public:
  explicit RenderedQuad(const Quad& quad) : normal_(normal_of(quad)) {
    const std::array<Imath::V3f, 4> c = corners(quad);
    const auto half = [&c](std::size_t at, std::size_t along_u, std::size_t along_v) {
      const Imath::V3d origin(c[at]);
      return Half{origin, Imath::V3d(c[along_u]) - origin, Imath::V3d(c[along_v]) - origin};
    };
    halves_ = {half(0, 1, 2), half(3, 2, 1)};
  }

  /// The point at (u, v) in [0, 1]^2, on one of the halves.
  [[nodiscard]] Imath::V3d at(double u, double v) const {
    const bool first = u + v <= 1;
    const Half& half = halves_[first ? 0 : 1];
    return half.origin + half.along_u * (first ? u : 1 - u) + half.along_v * (first ? v : 1 - v);
  }
  [[nodiscard]] const Imath::V3f& normal() const { return normal_; }

 private:
  struct Half {
    Imath::V3d origin, along_u, along_v;
  };
  std::array<Half, 2> halves_;
  Imath::V3f normal_;
};

/// Area of one side [m^2].
[[nodiscard]] inline double area(const Quad& quad) {
  return quad.edge_u.cross(quad.edge_v).length();
}

/// Box around the corners as rounded to float.
[[nodiscard]] inline Imath::Box3d bounds(const Quad& quad) {
  Imath::Box3d box;
  for (const Imath::V3f& corner : corners(quad)) box.extendBy(Imath::V3d(corner));
  return box;
}

/// Samples a point uniformly by area: the one at (u.x, u.y), for `u` in [0, 1]^2.
[[nodiscard]] inline SurfacePoint sample_area(const RenderedQuad& quad, Imath::V2f u) {
  return {Imath::V3f(quad.at(static_cast<double>(u.x), static_cast<double>(u.y))), quad.normal()};
}
[[nodiscard]] inline SurfacePoint sample_area(const Quad& quad, Imath::V2f u) {
  return sample_area(RenderedQuad(quad), u);
}

}  // namespace abbe

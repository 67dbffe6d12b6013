#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <variant>

#include "materials/bsdf/warp.h"
#include "scene/shapes/model.h"

namespace abbe {

// Besides the functions of `ShapeModel`, these shapes have:
// - `axial_irradiance`: irradiance for unit radiance [sr] of a surface that faces the shape, at that distance
//   [m] from the center along the normal; 0 inside a sphere;
// - `point_at`: area-preserving map from the unit square to the surface, and its inverse `uv_of`;
// - `anchor_of` flat shapes: the position by which they are placed.

/// A sphere [m]; its normal points away from the center.
struct Sphere {
  Imath::V3d center;
  double radius;
};

/// Nearest hit at t in (t_min, ray.t_max), from outside or inside; t is in units of the ray's direction. It
/// solves |o + t d - c| = r. The discriminant uses the distance between center and line, and the smaller root
/// follows from the product of both. This avoids cancellation for distant and large spheres. The point is
/// projected back to the sphere. [Haines2019]
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Sphere& sphere, const BasicRay<T>& ray, T t_min) {
  const Imath::Vec3<T> center(sphere.center);
  const T radius = static_cast<T>(sphere.radius);
  const Imath::Vec3<T> f = ray.origin - center;
  const T a = ray.direction.dot(ray.direction);
  const T b = -f.dot(ray.direction);
  const T half_chord2 = radius * radius - (f + ray.direction * (b / a)).length2();
  if (!(half_chord2 >= 0)) return std::nullopt;
  const T q = b + std::copysign(std::sqrt(a * half_chord2), b);
  const T distance = f.length();
  const T roots[2] = {(distance - radius) * (distance + radius) / q, q / a};
  const T near = std::min(roots[0], roots[1]);
  const T t = near > t_min ? near : std::max(roots[0], roots[1]);
  if (!(t > t_min && t < ray.t_max)) return std::nullopt;
  const Imath::Vec3<T> normal = (f + ray.direction * t).normalized();
  return ShapeHit<T>{t, center + normal * radius, normal};
}

/// Area [m^2].
[[nodiscard]] inline double area(const Sphere& sphere) {
  return 4 * std::numbers::pi * sphere.radius * sphere.radius;
}

[[nodiscard]] inline Imath::Box3d bounds(const Sphere& sphere) {
  const Imath::V3d r(sphere.radius);
  return {sphere.center - r, sphere.center + r};
}

/// Samples a point uniformly by area, by `u` in [0, 1]^2: u.x runs from +z to -z, u.y along the longitude.
[[nodiscard]] inline SurfacePoint sample_area(const Sphere& sphere, Imath::V2f u) {
  const double z = 1 - 2 * static_cast<double>(u.x);
  const double ring = std::sqrt((1 - z) * (1 + z));
  const double phi = 2 * std::numbers::pi * static_cast<double>(u.y);
  const Imath::V3d normal(ring * std::cos(phi), ring * std::sin(phi), z);
  return {Imath::V3f(sphere.center + normal * sphere.radius), Imath::V3f(normal)};
}

[[nodiscard]] SurfaceCoordinates coordinates_on(const Sphere& sphere, const Imath::V3d& point,
                                                std::size_t triangle);
[[nodiscard]] std::optional<Ball> ball_of(const Sphere& sphere);
[[nodiscard]] double axial_irradiance(const Sphere& sphere, double distance);
[[nodiscard]] double enclosed_volume(const Sphere& sphere);
[[nodiscard]] bool may_intersect(const Sphere& sphere, const Imath::Box3d& box);
[[nodiscard]] double thickness(const Sphere& sphere);
[[nodiscard]] OuterSide outer_side(const Sphere& sphere);
[[nodiscard]] Outline outline(const Sphere& sphere, const Imath::M44d& to_world, const DrawingPlane& plane);
[[nodiscard]] Imath::V3d point_at(const Sphere& sphere, const Imath::V2d& uv);
[[nodiscard]] Imath::V2d uv_of(const Sphere& sphere, const Imath::V3d& point);
void shift(Sphere& sphere, const Imath::V3d& by);
void transform(Sphere& sphere, const Imath::M44d& by, double scale);

/// A flat disc [m]; its outer side is that of `normal`, which has unit length.
struct Disc {
  Imath::V3d center;
  Imath::V3d normal;
  double radius;
};

/// Hit at t in (t_min, ray.t_max), on either side; t is in units of the ray's direction. The normal is that
/// of the disc, whatever the ray's direction. Nothing for a ray in the plane.
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Disc& disc, const BasicRay<T>& ray, T t_min) {
  const Imath::Vec3<T> normal(disc.normal);
  const Imath::Vec3<T> to_center = Imath::Vec3<T>(disc.center) - ray.origin;
  const T towards = ray.direction.dot(normal);
  if (towards == 0) return std::nullopt;
  const T t = to_center.dot(normal) / towards;
  if (!(t > t_min && t < ray.t_max)) return std::nullopt;
  const Imath::Vec3<T> across = ray.direction * t - to_center;
  if (across.length2() > static_cast<T>(disc.radius * disc.radius)) return std::nullopt;
  return ShapeHit<T>{t, Imath::Vec3<T>(disc.center) + across - normal * across.dot(normal), normal};
}

/// Area of one side [m^2].
[[nodiscard]] inline double area(const Disc& disc) {
  return std::numbers::pi * disc.radius * disc.radius;
}

[[nodiscard]] inline Imath::Box3d bounds(const Disc& disc) {
  const auto extent = [&disc](double n) { return disc.radius * std::sqrt(std::max(0.0, (1 - n) * (1 + n))); };
  const Imath::V3d half(extent(disc.normal.x), extent(disc.normal.y), extent(disc.normal.z));
  return {disc.center - half, disc.center + half};
}

/// Samples a point uniformly by area, by `u` in [0, 1]^2; the center for (0.5, 0.5).
[[nodiscard]] inline SurfacePoint sample_area(const Disc& disc, Imath::V2f u) {
  const Imath::V2d p = Imath::V2d(concentric_disc(u)) * disc.radius;
  return {Imath::V3f(disc.center + Basis<double>(disc.normal).to_world({p.x, p.y, 0})),
          Imath::V3f(disc.normal)};
}

[[nodiscard]] SurfaceCoordinates coordinates_on(const Disc& disc, const Imath::V3d& point,
                                                std::size_t triangle);
[[nodiscard]] inline const Imath::V3d& normal_of(const Disc& disc) {
  return disc.normal;
}
[[nodiscard]] inline Imath::V3d center_of(const Disc& disc) {
  return disc.center;
}
[[nodiscard]] inline const Imath::V3d& anchor_of(const Disc& disc) {
  return disc.center;
}
[[nodiscard]] Imath::V3d point_at(const Disc& disc, const Imath::V2d& uv);
[[nodiscard]] Imath::V2d uv_of(const Disc& disc, const Imath::V3d& point);
[[nodiscard]] std::optional<FlatFace> flat_face(const Disc& disc);
[[nodiscard]] double axial_irradiance(const Disc& disc, double distance);
[[nodiscard]] OuterSide outer_side(const Disc& disc);
[[nodiscard]] Outline outline(const Disc& disc, const Imath::M44d& to_world, const DrawingPlane& plane);
void shift(Disc& disc, const Imath::V3d& by);
void transform(Disc& disc, const Imath::M44d& by, double scale);

/// A parallelogram [m]: corner + u edge_u + v edge_v for u and v in [0, 1], outward normal along edge_u x
/// edge_v.
struct Quad {
  Imath::V3d corner;
  Imath::V3d edge_u;
  Imath::V3d edge_v;
};

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

/// Outward unit normal.
[[nodiscard]] inline Imath::V3d normal_of(const Quad& quad) {
  return quad.edge_u.cross(quad.edge_v).normalized();
}

/// A quad prepared for sampling: its halves are the triangles of `triangles_of`, with corners rounded to
/// float.
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

[[nodiscard]] SurfaceCoordinates coordinates_on(const Quad& quad, const Imath::V3d& point,
                                                std::size_t triangle);
[[nodiscard]] Imath::V3d point_at(const Quad& quad, const Imath::V2d& uv);
[[nodiscard]] Imath::V2d uv_of(const Quad& quad, const Imath::V3d& point);
[[nodiscard]] inline Imath::V3d center_of(const Quad& quad) {
  return point_at(quad, {0.5, 0.5});
}
[[nodiscard]] inline const Imath::V3d& anchor_of(const Quad& quad) {
  return quad.corner;
}
[[nodiscard]] std::optional<FlatFace> flat_face(const Quad& quad);
[[nodiscard]] double axial_irradiance(const Quad& quad, double distance);
[[nodiscard]] TriangleSet triangles_of(const Quad& quad);
[[nodiscard]] Imath::V3d normal_at(const Quad& quad, std::size_t triangle);
[[nodiscard]] OuterSide outer_side(const Quad& quad);
[[nodiscard]] Outline outline(const Quad& quad, const Imath::M44d& to_world, const DrawingPlane& plane);
void shift(Quad& quad, const Imath::V3d& by);
void transform(Quad& quad, const Imath::M44d& by, double scale);

/// Shapes of one flat face.
using FlatShape = std::variant<Quad, Disc>;

}  // namespace abbe

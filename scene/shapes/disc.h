#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "materials/bsdf/warp.h"
#include "scene/shapes/basis.h"
#include "scene/shapes/shape.h"

namespace abbe {

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

}  // namespace abbe

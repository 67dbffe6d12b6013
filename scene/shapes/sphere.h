#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "scene/shapes/shape.h"

namespace abbe {

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

}  // namespace abbe

#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scene/shapes/ray.h"

namespace abbe {

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

}  // namespace abbe

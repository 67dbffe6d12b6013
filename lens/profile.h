#pragma once

#include <array>
#include <optional>

#include <ImathVec.h>

#include "lens/numbers.h"

namespace abbe::lens {

/// A ray in millimetres; its direction is a unit vector, along which it travels.
template <typename Real>
struct BasicRay {
  Imath::Vec3<Real> origin;
  Imath::Vec3<Real> direction;
};
using Ray = BasicRay<double>;

/// Distance to an intersection along a ray. `length_mm` has no meaning unless it exists.
template <typename Real>
struct Intersection {
  Mask<Real> exists;
  Real length_mm;
};

/// Surface of revolution about z with its vertex in the origin [Welford1986]. It is a conic of curvature c
/// and conic constant k, plus even powers of the distance r from the axis:
///
///   z(r) = c r^2/(1 + sqrt(1 - (1 + k) c^2 r^2)) + a_1 r^2 + a_2 r^4 + ... + a_10 r^20.
///
/// Lengths are in millimetres, and points and rays in the coordinates of the surface. Templates are
/// instantiated for `double`, `Doubles` and `Floats`.
struct Profile {
  /// 1/radius [1/mm], positive if the center of curvature is towards +z; 0 for a plane.
  double curvature = 0;
  double conic = 0;               ///< 0 for a sphere, -1 for a paraboloid.
  std::array<double, 10> even{};  ///< a_1 to a_10; a_i in mm^(1 - 2i).

  /// True if any a_i is not 0. A conic alone is not aspheric here.
  [[nodiscard]] bool aspheric() const;
  /// Curvature at the vertex, c + 2 a_1.
  [[nodiscard]] double vertex_curvature() const { return curvature + 2 * even[0]; }
  /// Height z [mm] at the squared distance from the axis [mm^2]; NaN outside the edge of the conic.
  [[nodiscard]] double sag(double r2) const;
  /// Unit normal towards +z at a point of the surface.
  template <typename Real>
  [[nodiscard]] Imath::Vec3<Real> normal(const Imath::Vec3<Real>& point) const;
  /// Intersection at which the ray passes from the -z side to the +z side, accurate to rounding. The distance
  /// is negative behind the origin of the ray. Rays that travel towards -z must be reversed first.
  template <typename Real>
  [[nodiscard]] Intersection<Real> find_intersection(const BasicRay<Real>& ray) const;
  /// Distance of that intersection; nothing if the ray misses.
  [[nodiscard]] std::optional<double> intersect(const Ray& ray) const;
};

}  // namespace abbe::lens

#pragma once

#include <array>
#include <optional>

#include <ImathVec.h>

#include "lens/numbers.h"

namespace abbe::lens {

/// A ray in millimetres; its direction is a unit vector.
template <typename Real>
struct BasicRay {
  Imath::Vec3<Real> origin;
  Imath::Vec3<Real> direction;
};
using Ray = BasicRay<double>;

/// How far along a ray something is met, if it is.
template <typename Real>
struct Meeting {
  Truth<Real> met;
  Real length_mm;
};

/// The form of a surface of revolution about z with its vertex in the origin: a conic of curvature c and
/// conic constant k, and powers of the distance r from the axis,
///
///   z(r) = c r^2/(1 + sqrt(1 - (1 + k) c^2 r^2)) + a_1 r^2 + a_2 r^4 + ... + a_10 r^20.
///
/// Lengths are millimetres. Templates are there for `double`, `Doubles` and `Floats`. [Welford1986]
struct Profile {
  double curvature = 0;           ///< 1/radius, positive where the centre lies towards +z; 0 for a plane.
  double conic = 0;               ///< 0 for a sphere, -1 for a paraboloid.
  std::array<double, 10> even{};  ///< a_1 to a_10.

  [[nodiscard]] bool aspheric() const;
  /// c + 2 a_1: the curvature at the vertex.
  [[nodiscard]] double vertex_curvature() const { return curvature + 2 * even[0]; }
  /// z at the square of the distance from the axis; NaN beyond the edge of the conic.
  [[nodiscard]] double sag(double r2) const;
  /// The unit normal towards +z at a point of the surface.
  template <typename Real>
  [[nodiscard]] Imath::Vec3<Real> normal(const Imath::Vec3<Real>& point) const;
  /// Where the ray passes the surface from the side of -z to that of +z, to rounding; negative behind its
  /// origin.
  template <typename Real>
  [[nodiscard]] Meeting<Real> meet(const BasicRay<Real>& ray) const;
  /// How far along the ray that is; nothing when it misses.
  [[nodiscard]] std::optional<double> intersect(const Ray& ray) const;
};

}  // namespace abbe::lens

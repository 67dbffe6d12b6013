#pragma once

#include <cmath>
#include <optional>

#include "scene/shapes/model.h"

namespace abbe {

/// A part of a quadric of revolution [m]: a cylinder, a cone or a paraboloid. Its points at the height z
/// along `axis` are at the distance sqrt(constant + linear z + quadratic z^2) from it. One of these
/// coefficients is positive, and the others are 0. Its outer side is away from the axis.
struct Quadric {
  Imath::V3d origin;     ///< Point of the axis at z = 0; the apex of a cone, the vertex of a paraboloid.
  Imath::V3d axis;       ///< Unit vector.
  double constant = 0;   ///< Squared radius of a cylinder [m^2].
  double linear = 0;     ///< 4 focal lengths of a paraboloid [m].
  double quadratic = 0;  ///< Squared slope of a cone.
  double low = 0;        ///< Smallest z [m]: -height of a cone, 0 otherwise.
  double high = 0;       ///< Largest z [m]: 0 for a cone.
  bool caps = false;     ///< True if discs close the ends, so that a cylinder or cone is a solid.

  /// Distance of the points at height z from the axis.
  [[nodiscard]] double radius(double z) const { return std::sqrt(constant + z * (linear + z * quadratic)); }
};

/// The cylinder from one center to another, which must differ.
[[nodiscard]] Quadric cylinder(const Imath::V3d& from, const Imath::V3d& to, double radius, bool caps);
/// The cone over a disc of that radius. `base` is its center; it must differ from `apex`.
[[nodiscard]] Quadric cone(const Imath::V3d& base, const Imath::V3d& apex, double radius, bool caps);
/// The paraboloid with that vertex and focal length, out to the distance `radius` from its unit axis. It
/// opens along the axis.
[[nodiscard]] Quadric paraboloid(const Imath::V3d& vertex, const Imath::V3d& axis, double focal_length,
                                 double radius);

/// Nearest hit at t in (t_min, ray.t_max), from either side; t is in units of the ray's direction. The ray is
/// first shifted to the center of the shape, so that distance costs no precision. The discriminant is
/// computed with fused operations, and the smaller root from the product of both.
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Quadric& quadric, const BasicRay<T>& ray, T t_min);
/// Area of the outer side with the caps [m^2].
[[nodiscard]] double area(const Quadric& quadric);
[[nodiscard]] Imath::Box3d bounds(const Quadric& quadric);
/// Samples a point uniformly by area, by `u` in [0, 1]^2.
[[nodiscard]] SurfacePoint sample_area(const Quadric& quadric, Imath::V2f u);
[[nodiscard]] SurfaceCoordinates coordinates_on(const Quadric& quadric, const Imath::V3d& point,
                                                std::size_t triangle);
[[nodiscard]] double enclosed_volume(const Quadric& quadric);
[[nodiscard]] double thickness(const Quadric& quadric);
/// The rims, and two meridians that are opposite to each other as viewed.
[[nodiscard]] Outline outline(const Quadric& quadric, const Imath::M44d& to_world, const DrawingPlane& plane);
void shift(Quadric& quadric, const Imath::V3d& by);
void transform(Quadric& quadric, const Imath::M44d& by, double scale);

}  // namespace abbe

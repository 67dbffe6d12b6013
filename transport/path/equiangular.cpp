#include "transport/path/equiangular.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abbe {
namespace {

struct Interval {
  double from, to;
};

// Interval of t in which the points m + t d lie within a cone around `axis` with its apex at the origin.
// `sin2` is the squared sine of its half angle, which is below 90 degrees: |x_perp|^2 cos^2 <= x_par^2 sin^2
// with x_par > 0.
std::optional<Interval> within_cone(const Imath::V3d& m, const Imath::V3d& d, const Imath::V3d& axis,
                                    double sin2) {
  const double cos2 = 1 - sin2;
  const double m_along = m.dot(axis);
  const double d_along = d.dot(axis);
  const Imath::V3d m_off = m - axis * m_along;
  const Imath::V3d d_off = d - axis * d_along;
  const double a = d_off.length2() * cos2 - d_along * d_along * sin2;
  const double b = m_off.dot(d_off) * cos2 - m_along * d_along * sin2;
  const double c = m_off.length2() * cos2 - m_along * m_along * sin2;
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0) || a == 0) return std::nullopt;
  // The first root adds terms of equal sign; the other follows from the product of both roots.
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const auto [first, second] = std::minmax({q / a, c / q});
  if (a > 0) {
    // within the mirror image of the cone
    if (!(m_along + (first + second) / 2 * d_along > 0)) return std::nullopt;
    return Interval{first, second};
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return d_along > 0 ? Interval{second, kInfinity} : Interval{-kInfinity, first};
}

}  // namespace

Equiangular::Equiangular(double from, double to, double foot, double height)
    : from_(static_cast<float>(from)),
      to_(static_cast<float>(to)),
      foot_(foot),
      height_(height),
      low_(std::atan2(from - foot, height)),
      high_(std::atan2(to - foot, height)) {}

std::optional<Equiangular> Equiangular::along(const Ray& ray, float length, const Light& light) {
  const std::optional<Imath::V3f> position = position_at(light, ray.time);
  if (!position) return std::nullopt;
  const Imath::V3d m = Imath::V3d(ray.origin) - Imath::V3d(*position);
  const Imath::V3d d(ray.direction);
  Interval part{0, length};
  if (const std::optional<DirectionCone> cone = cone_at(light, ray.time); cone && cone->cap < 1) {
    const double cap = cone->cap;
    const auto inside = within_cone(m, d, Imath::V3d(cone->axis), cap * (2 - cap));
    if (!inside) return std::nullopt;
    part = {std::max(part.from, inside->from), std::min(part.to, inside->to)};
  }
  if (!(part.from < part.to)) return std::nullopt;
  const double foot = -m.dot(d);
  // A ray through the light itself would have its entire density at one point.
  constexpr double kMinRelativeHeight = 1e-6;
  const double height = std::max((m + d * foot).length(), kMinRelativeHeight * m.length());
  if (!(height > 0)) return std::nullopt;
  return Equiangular(part.from, part.to, foot, height);
}

float Equiangular::sample(float u) const {
  const double t = foot_ + height_ * std::tan(low_ + (high_ - low_) * static_cast<double>(u));
  return std::clamp(static_cast<float>(t), from_, to_);
}

float Equiangular::pdf(float distance) const {
  if (!(distance >= from_ && distance <= to_)) return 0;
  const double from_foot = static_cast<double>(distance) - foot_;
  return static_cast<float>(height_ / ((high_ - low_) * (height_ * height_ + from_foot * from_foot)));
}

}  // namespace abbe

#include "lens/iris.h"

#include <cmath>
#include <numbers>

namespace abbe::lens {

Iris::Iris(int blades, double rotation_deg)
    : rotation_(rotation_deg * std::numbers::pi / 180), half_angle_(std::numbers::pi / blades) {}

Iris::BladeCoordinates Iris::blade_coordinates(const Imath::V2d& point) const {
  const double clockwise = std::atan2(point.x, point.y);
  const double angle = std::remainder(clockwise - rotation_ - half_angle_, 2 * half_angle_);
  return {point.length(), angle, clockwise - angle};
}

// An edge is at the distance cos(half angle) from the center.
bool Iris::contains(const Imath::V2d& point) const {
  const BladeCoordinates at = blade_coordinates(point);
  return at.radius * std::cos(at.angle) <= std::cos(half_angle_);
}

double Iris::area_fraction() const {
  return std::sin(2 * half_angle_) / (2 * half_angle_);
}

// Maps an arc of the disc to the chord at the same fraction of the radius, with lengths proportional to
// angles. The element of area r dr dphi becomes cos(h) sin(h)/h r dr dphi everywhere, where h is the half
// angle.
Imath::V2d Iris::point(const Imath::V2d& disc) const {
  const BladeCoordinates at = blade_coordinates(disc);
  const double out = at.radius * std::cos(half_angle_);
  const double along = at.radius * std::sin(half_angle_) * (at.angle / half_angle_);
  const double sine = std::sin(at.blade_angle);
  const double cosine = std::cos(at.blade_angle);
  return {out * sine + along * cosine, out * cosine - along * sine};
}

}  // namespace abbe::lens

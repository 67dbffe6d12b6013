#include "scene/lights/spherical_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace abbe {
namespace {

// Area over squared distance below which a rectangle looks small: the cosine and distance over it vary little
// enough for the cheaper sampling by area to reach an error sooner.
constexpr double kSmall = 0.5;
// Height over size below which it is seen edge-on, and the sum of angles cancels.
constexpr double kEdgeOn = 1e-4;

}  // namespace

std::optional<SphericalRectangle> SphericalRectangle::seen_from(const Quad& quad, const Imath::V3d& point) {
  const Imath::V3d to_corner = quad.corner - point;
  const double size_u = quad.edge_u.length();
  const double size_v = quad.edge_v.length();
  const double distance2 = (to_corner + (quad.edge_u + quad.edge_v) * 0.5).length2();
  if (size_u * size_v < kSmall * distance2) return std::nullopt;
  if (std::abs(quad.edge_u.dot(quad.edge_v)) > 1e-9 * size_u * size_v) return std::nullopt;
  const Imath::V3d x = quad.edge_u / size_u;
  const Imath::V3d y = quad.edge_v / size_v;

  SphericalRectangle r;
  r.height_ = std::abs(to_corner.dot(x.cross(y)));
  if (r.height_ < kEdgeOn * std::max({size_u, size_v, std::sqrt(distance2)})) return std::nullopt;
  r.x0_ = to_corner.dot(x);
  r.x1_ = r.x0_ + size_u;
  r.y0_ = to_corner.dot(y);
  r.y1_ = r.y0_ + size_v;
  const auto tilt = [&r](double edge) { return edge / std::sqrt(r.height_ * r.height_ + edge * edge); };
  // Normals of the planes through the edges, going round; only their z enters the angles between neighbours.
  r.b0_ = -tilt(r.y0_);
  const double right = tilt(r.x1_);
  r.b1_ = tilt(r.y1_);
  const double left = -tilt(r.x0_);
  r.k_ = 2 * std::numbers::pi - std::acos(-r.b1_ * left) - std::acos(-left * r.b0_);
  r.solid_angle_ = std::acos(-r.b0_ * right) + std::acos(-right * r.b1_) - r.k_;
  return r;
}

Imath::V2d SphericalRectangle::sample(Imath::V2f u) const {
  // The plane x = const through the point that has the share u.x of the solid angle on its left.
  const double angle = static_cast<double>(u.x) * solid_angle_ + k_;
  const double f = (std::cos(angle) * b0_ - b1_) / std::sin(angle);
  const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + b0_ * b0_), f), -1.0, 1.0);
  const double x = std::clamp(c * height_ / std::sqrt(std::max((1 - c) * (1 + c), 1e-300)), x0_, x1_);
  // On that line equal steps of sine are equal solid angles.
  const double d2 = x * x + height_ * height_;
  const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_);
  const double h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
  const double h = h0 + static_cast<double>(u.y) * (h1 - h0);
  const double y = std::clamp(h * std::sqrt(d2 / std::max((1 - h) * (1 + h), 1e-300)), y0_, y1_);
  return {(x - x0_) / (x1_ - x0_), (y - y0_) / (y1_ - y0_)};
}

}  // namespace abbe

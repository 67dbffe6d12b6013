#include "scene/lights/spherical_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace abbe {
namespace {

// Area over squared distance below which a rectangle is small. Cosine and distance then vary little, and the
// cheaper sampling by area has the lower error per time.
constexpr double kSmall = 0.5;
// Ratio of height to size below which a rectangle is seen edge-on and the sum of angles cancels.
constexpr double kEdgeOn = 1e-4;

}  // namespace

std::optional<Rectangle> Rectangle::of(const Quad& quad) {
  const double size_u = quad.edge_u.length();
  const double size_v = quad.edge_v.length();
  if (std::abs(quad.edge_u.dot(quad.edge_v)) > 1e-9 * size_u * size_v) return std::nullopt;
  return Rectangle{quad.corner,
                   quad.corner + (quad.edge_u + quad.edge_v) * 0.5,
                   quad.edge_u / size_u,
                   quad.edge_v / size_v,
                   size_u,
                   size_v};
}

std::optional<SphericalRectangle> SphericalRectangle::project(const Rectangle& rectangle,
                                                              const Imath::V3d& point) {
  const auto& [corner, center, x, y, size_u, size_v] = rectangle;
  const double distance2 = (center - point).length2();
  if (size_u * size_v < kSmall * distance2) return std::nullopt;
  const Imath::V3d to_corner = corner - point;
  SphericalRectangle r;
  r.height_ = std::abs(to_corner.dot(x.cross(y)));
  if (r.height_ < kEdgeOn * std::max({size_u, size_v, std::sqrt(distance2)})) return std::nullopt;
  r.x0_ = to_corner.dot(x);
  r.x1_ = r.x0_ + size_u;
  r.y0_ = to_corner.dot(y);
  r.y1_ = r.y0_ + size_v;
  r.start_ = r.turn_at(r.x0_);
  const Imath::V2d end = r.turn_at(r.x1_);
  const double angle = std::atan2(r.start_.cross(end), r.start_.dot(end));
  r.solid_angle_ = angle < 0 ? angle + 2 * std::numbers::pi : angle;
  return r;
}

// The solid angle between (0, 0) and (x, y) in a plane at height h is atan(x y/(h r)), where r is the
// distance of that corner. The difference for y1 and y0 is the argument of (h r1 + i x y1)(h r0 - i x y0).
// Its magnitude is (x^2 + h^2) sqrt((h^2 + y0^2)(h^2 + y1^2)).
Imath::V2d SphericalRectangle::turn_at(double x) const {
  const double d2 = x * x + height_ * height_;
  const double r0 = std::sqrt(d2 + y0_ * y0_);
  const double r1 = std::sqrt(d2 + y1_ * y1_);
  return {height_ * height_ * r0 * r1 + x * x * y0_ * y1_, x * height_ * (y1_ * r0 - y0_ * r1)};
}

Imath::V2d SphericalRectangle::sample(Imath::V2f u) const {
  // The z components of the normals of the planes through the point and the edges y = y0 and y = y1.
  const double far0 = std::sqrt(height_ * height_ + y0_ * y0_);
  const double far1 = std::sqrt(height_ * height_ + y1_ * y1_);
  const double b0 = -y0_ / far0;
  const double b1 = y1_ / far1;
  // The plane x = const through the point that has the fraction u.x of the solid angle on its left.
  const double angle = static_cast<double>(u.x) * solid_angle_;
  const Imath::V2d turn(std::cos(angle), std::sin(angle));
  const double real = start_.x * turn.x - start_.y * turn.y;
  const double imaginary = start_.x * turn.y + start_.y * turn.x;
  const double magnitude = (x0_ * x0_ + height_ * height_) * far0 * far1;
  const double f = (real * b0 + magnitude * b1) / imaginary;
  const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + b0 * b0), f), -1.0, 1.0);
  const double x = std::clamp(c * height_ / std::sqrt(std::max((1 - c) * (1 + c), 1e-300)), x0_, x1_);
  // On that line, equal steps of the sine are equal solid angles.
  const double d2 = x * x + height_ * height_;
  const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_);
  const double h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
  const double h = h0 + static_cast<double>(u.y) * (h1 - h0);
  const double y = std::clamp(h * std::sqrt(d2 / std::max((1 - h) * (1 + h), 1e-300)), y0_, y1_);
  return {(x - x0_) / (x1_ - x0_), (y - y0_) / (y1_ - y0_)};
}

}  // namespace abbe

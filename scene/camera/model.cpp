#include "scene/camera/model.h"

#include <cmath>
#include <limits>

#include "scene/shapes/basic.h"

namespace abbe {
namespace {

std::optional<double> crossing_of(const FlatOpening& opening, const Ray& ray) {
  const auto& [center, u, v, normal, round, iris] = opening;
  const Imath::V3d along(ray.direction);
  const double inward = -along.dot(normal);
  if (!(inward > 0)) return std::nullopt;
  const Imath::V3d from = Imath::V3d(ray.origin) - center;
  const double t = from.dot(normal) / inward;
  if (!(t > 0)) return std::nullopt;
  const Imath::V3d across = u.cross(v);
  const Imath::V3d point = from + along * t;
  const double a = point.cross(v).dot(across) / across.length2();
  const double b = u.cross(point).dot(across) / across.length2();
  const bool within = round ? a * a + b * b <= 1 : std::abs(a) <= 1 && std::abs(b) <= 1;
  const bool passes = within && (!iris || iris->contains({a, b}));
  return passes ? std::optional(t) : std::nullopt;
}

// A ray from inside crosses the opening where it leaves the sphere.
std::optional<double> crossing_of(const SphereSide& side, const Ray& ray) {
  const BasicRay<double> light{Imath::V3d(ray.origin), Imath::V3d(ray.direction),
                               std::numeric_limits<double>::infinity(), ray.time};
  const auto leaves = [&](const ShapeHit<double>& hit) { return hit.normal.dot(light.direction) > 0; };
  auto hit = intersect(side.sphere, light, 0.0);
  if (hit && side.inwards && !leaves(*hit)) hit = intersect(side.sphere, light, hit->t);
  return hit && leaves(*hit) == side.inwards ? std::optional(hit->t) : std::nullopt;
}

double radius_of(const FlatOpening& opening) {
  return opening.u.length() + opening.v.length();
}

double radius_of(const SphereSide& side) {
  return side.sphere.radius;
}

}  // namespace

std::optional<double> crossing(const Opening& opening, const Ray& ray) {
  return std::visit([&](const auto& of) { return crossing_of(of, ray); }, opening);
}

double opening_radius(const Opening& opening) {
  return std::visit([](const auto& of) { return radius_of(of); }, opening);
}

}  // namespace abbe

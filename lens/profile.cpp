#include "lens/profile.h"

#include <algorithm>
#include <cmath>

namespace abbe::lens {
namespace {

using V3d = Imath::V3d;

constexpr int kMaxNewtonSteps = 60;
constexpr double kConverged = 1e-14;  // of the distance, or of a millimetre

// The conic is c (x^2 + y^2 + (1 + k) z^2) - 2 z = 0; of the ray's two points on it the one is taken where
// the gradient (-c x, -c y, 1 - (1 + k) c z) has the ray's sense, which must be on the vertex's sheet.
std::optional<double> intersect_conic(double c, double k, const V3d& o, const V3d& d) {
  const double a = c * (1 + k * d.z * d.z);
  const double b = d.z - c * (o.dot(d) + k * o.z * d.z);
  const double rest = c * (o.length2() + k * o.z * o.z) - 2 * o.z;
  const double square = b * b - a * rest;
  if (!(square > 0)) return std::nullopt;
  const double root = std::sqrt(square);
  const double t = b + root > 0 ? rest / (b + root) : (b - root) / a;
  if (!(1 - (1 + k) * c * (o.z + t * d.z) > 0)) return std::nullopt;
  return t;
}

}  // namespace

bool Profile::aspheric() const {
  double sizes = 0;
  for (const double a : even) sizes += std::abs(a);
  return sizes != 0;
}

double Profile::sag(double r2) const {
  double powers = 0;
  for (std::size_t i = even.size(); i-- > 0;) powers = (powers + even[i]) * r2;
  return curvature * r2 / (1 + std::sqrt(1 - (1 + conic) * curvature * curvature * r2)) + powers;
}

double Profile::slope(double r2) const {
  double powers = 0;
  for (std::size_t i = even.size(); i-- > 0;) powers = powers * r2 + static_cast<double>(i + 1) * even[i];
  return curvature / (2 * std::sqrt(1 - (1 + conic) * curvature * curvature * r2)) + powers;
}

V3d Profile::normal(const V3d& point) const {
  if (!aspheric())  // from z, which is exact where the sheet is steep
    return V3d(-curvature * point.x, -curvature * point.y, 1 - (1 + conic) * curvature * point.z)
        .normalized();
  const double s = 2 * slope(point.x * point.x + point.y * point.y);
  return V3d(-s * point.x, -s * point.y, 1).normalized();
}

std::optional<double> Profile::intersect(const Ray& ray) const {
  // From the point nearest to the vertex on, so that the squares of far origins do not swamp the rest.
  const double nearest = -ray.origin.dot(ray.direction);
  const V3d o = ray.origin + nearest * ray.direction;
  const V3d& d = ray.direction;
  const auto conic_t = intersect_conic(curvature, conic, o, d);
  if (!aspheric()) return conic_t ? std::optional(nearest + *conic_t) : std::nullopt;
  double t = conic_t.value_or(d.z != 0 ? -o.z / d.z : 0);
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const V3d p = o + t * d;
    const double r2 = p.x * p.x + p.y * p.y;
    const double towards = d.z - 2 * slope(r2) * (p.x * d.x + p.y * d.y);
    const double change = (p.z - sag(r2)) / towards;
    if (!std::isfinite(change)) return std::nullopt;
    t -= change;
    if (std::abs(change) <= kConverged * std::max(1.0, std::abs(t)))
      return towards > 0 ? std::optional(nearest + t) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace abbe::lens

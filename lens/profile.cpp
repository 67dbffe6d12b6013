#include "lens/profile.h"

#include <cmath>
#include <limits>

namespace abbe::lens {
namespace {

using Imath::Vec3;

constexpr int kMaxNewtonSteps = 60;
// Relative to the distance, or to a millimetre for shorter ones.
template <typename Scalar>
constexpr Scalar kConverged = 45 * std::numeric_limits<Scalar>::epsilon();

// The conic is c (x^2 + y^2 + (1 + k) z^2) - 2 z = 0. Of the two intersections, the one counts at which the
// gradient (-c x, -c y, 1 - (1 + k) c z) points along the ray. It must lie on the sheet of the vertex. A
// plane has none for rays that travel backwards.
template <typename Real>
Intersection<Real> intersect_conic(double c, double k, const BasicRay<Real>& ray) {
  using std::abs;
  using std::sqrt;
  const auto& [o, d] = ray;
  const Real a = c * (1 + k * d.z * d.z);
  const Real b = d.z - c * (o.dot(d) + k * o.z * d.z);
  const Real rest = c * (o.dot(o) + k * o.z * o.z) - 2 * o.z;
  const Real square = b * b - a * rest;
  const Real root = sqrt(select(square > 0, square, 1));
  const Mask<Real> onwards = b + root > 0;
  const Real divisor = select(onwards, b + root, a);
  const Mask<Real> there = abs(divisor) > 0;
  const Real t = select(onwards, rest, b - root) / select(there, divisor, 1);
  return {square > 0 && there && (1 - (1 + k) * c * (o.z + t * d.z) > 0), t};
}

template <typename Real>
Real conic_root(const Profile& of, const Real& r2) {
  using std::sqrt;
  return sqrt(1 - (1 + of.conic) * of.curvature * of.curvature * r2);
}

template <typename Real>
Real sag_at(const Profile& of, const Real& r2) {
  Real powers = 0;
  for (std::size_t i = of.even.size(); i-- > 0;) powers = (powers + of.even[i]) * r2;
  return of.curvature * r2 / (1 + conic_root(of, r2)) + powers;
}

// dz/d(r^2).
template <typename Real>
Real slope_at(const Profile& of, const Real& r2) {
  Real powers = 0;
  for (std::size_t i = of.even.size(); i-- > 0;)
    powers = powers * r2 + static_cast<double>(i + 1) * of.even[i];
  return of.curvature / (2 * conic_root(of, r2)) + powers;
}

// Newton's method from the distance `start`.
template <typename Real>
Intersection<Real> intersect_asphere(const Profile& of, const BasicRay<Real>& ray, const Real& start) {
  using std::abs;
  const auto& [o, d] = ray;
  Intersection<Real> intersection{false, start};
  Mask<Real> seeking = true;
  for (int step = 0; step < kMaxNewtonSteps && bool(seeking); ++step) {
    Real& t = intersection.length_mm;
    const Vec3<Real> p = o + d * t;
    const Real r2 = p.x * p.x + p.y * p.y;
    const Real toward = d.z - 2 * slope_at(of, r2) * (p.x * d.x + p.y * d.y);
    const Real change = (p.z - sag_at(of, r2)) / toward;
    seeking = seeking && abs(change) <= Real(std::numeric_limits<ScalarOf<Real>>::max());
    t -= select(seeking, change, 0);
    const Real close = kConverged<ScalarOf<Real>> * select(abs(t) > 1, abs(t), 1);
    intersection.exists = intersection.exists || (seeking && abs(change) <= close && toward > 0);
    seeking = seeking && abs(change) > close;
  }
  return intersection;
}

}  // namespace

bool Profile::aspheric() const {
  bool any = false;
  for (const double a : even)
    any |= a != 0;  // visits all of them, which vectorises and is faster than a search
  return any;
}

double Profile::sag(double r2) const {
  return sag_at(*this, r2);
}

template <typename Real>
Vec3<Real> Profile::normal(const Vec3<Real>& point) const {
  if (!aspheric()) {  // from z, which is exact on steep parts of the sheet
    const Vec3<Real> up(-curvature * point.x, -curvature * point.y, 1 - (1 + conic) * curvature * point.z);
    return conic == 0 ? up
                      : unit(up);  // for a sphere, this is the direction to the center in units of the radius
  }
  const Real s = 2 * slope_at(*this, Real(point.x * point.x + point.y * point.y));
  return unit(Vec3<Real>(-s * point.x, -s * point.y, 1));
}

template <typename Real>
Intersection<Real> Profile::find_intersection(const BasicRay<Real>& ray) const {
  using std::abs;
  // Starts at the point nearest to the vertex, so that large coordinates of the origin do not cause
  // cancellation.
  const Real nearest = -ray.origin.dot(ray.direction);
  const BasicRay<Real> near{ray.origin + ray.direction * nearest, ray.direction};
  Intersection<Real> intersection = intersect_conic(curvature, conic, near);
  if (aspheric())
    intersection =
        intersect_asphere(*this, near,
                          select(intersection.exists, intersection.length_mm,
                                 select(abs(near.direction.z) > 0, -near.origin.z / near.direction.z, 0)));
  return {intersection.exists, nearest + intersection.length_mm};
}

std::optional<double> Profile::intersect(const Ray& ray) const {
  const auto [exists, length_mm] = find_intersection(ray);
  return exists ? std::optional(length_mm) : std::nullopt;
}

template Vec3<double> Profile::normal(const Vec3<double>&) const;
template Vec3<Doubles> Profile::normal(const Vec3<Doubles>&) const;
template Vec3<Floats> Profile::normal(const Vec3<Floats>&) const;
template Intersection<double> Profile::find_intersection(const Ray&) const;
template Intersection<Doubles> Profile::find_intersection(const BasicRay<Doubles>&) const;
template Intersection<Floats> Profile::find_intersection(const BasicRay<Floats>&) const;

}  // namespace abbe::lens

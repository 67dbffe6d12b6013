#include "lens/beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "io/error.h"
#include "lens/paraxial.h"

namespace abbe::lens {
namespace {

using V2d = Imath::V2d;
using V3d = Imath::V3d;

constexpr int kMaxAimingSteps = 40;
constexpr int kMaxHalvings = 20;
constexpr double kAimed = 1e-12;      // target of Newton's method, in radii of the stop
constexpr double kGoodEnough = 1e-9;  // accepted if rounding prevents the target
constexpr double kDifference = 1e-4;  // step for the Jacobian, in radii of the beam
constexpr double kFieldStep = 0.1;    // fraction of the field from one chief ray to the next
constexpr double kMinStep = 1e-4;
constexpr int kRimRays = 32;

// Solves the linear system of a Jacobian, given by columns: the change of the argument that changes the
// function by `wanted`.
V2d solved(const V2d& by_x, const V2d& by_y, const V2d& wanted) {
  const double det = by_x.x * by_y.y - by_y.x * by_x.y;
  return V2d(wanted.x * by_y.y - by_y.x * wanted.y, by_x.x * wanted.y - wanted.x * by_x.y) / det;
}

}  // namespace

Beam::Beam(const SystemAt& at, double stop_radius_mm) : at_(&at), radius_(stop_radius_mm) {
  const FirstOrder first = first_order(at);
  const auto& distance = at.system->object_distance_mm;
  pupil_z_ = std::isfinite(first.entrance_pupil_mm) && !distance ? first.entrance_pupil_mm : 0;
  // Paraxial height at the stop of a ray over its height in the launch plane.
  const double stop_over_launch =
      std::abs(1 / first.entrance_magnification + (distance ? first.stop_by_slope_mm / *distance : 0));
  scale_ = radius_ / (stop_over_launch > 0 ? stop_over_launch : 1);
}

void Beam::set_field(double field) {
  if (const auto distance = at_->system->object_distance_mm) {
    object_ = {0, field, -*distance};
  } else {
    const double angle = field * std::numbers::pi / 180;
    direction_ = {0, std::sin(angle), std::cos(angle)};
  }
}

Ray Beam::launch(const V2d& p) const {
  if (at_->system->object_distance_mm) {
    // Far objects are rounded more coarsely than the stop allows, so the ray does not start there.
    const V3d through(p.x, p.y, 0);
    return {through, (through - object_).normalized()};
  }
  const V3d up(0, direction_.z, -direction_.y);
  return {V3d(p.x, 0, pupil_z_) + p.y * up, direction_};
}

double Beam::density(const V2d& p) const {
  if (!at_->system->object_distance_mm) return 1;
  const V3d to = V3d(p.x, p.y, 0) - object_;
  const double distance2 = to.length2();
  return to.z * to.z / (distance2 * distance2);
}

std::optional<V2d> Beam::pupil_of(const V2d& launched) const {
  const std::size_t stop = at_->system->stop;
  const RayPath path = trace(*at_, launch(launched), Apertures::ignored, stop + 1);
  // The position at the stop is valid even if the ray ends behind it.
  if (path.hits.size() <= stop) return std::nullopt;
  const V3d point = local_point(*at_, stop, path.hits[stop].point);
  return V2d(point.x, point.y) / radius_;
}

// Newton's method with a finite-difference Jacobian. Steps are halved until the error decreases.
bool Beam::solve(const V2d& pupil, V2d& launched) const {
  auto now = pupil_of(launched);
  if (!now) return false;
  const double h = kDifference * scale_;
  for (int step = 0; step < kMaxAimingSteps; ++step) {
    const double error = (*now - pupil).length();
    if (error <= kAimed) return true;
    const auto x0 = pupil_of(launched - V2d(h, 0));
    const auto x1 = pupil_of(launched + V2d(h, 0));
    const auto y0 = pupil_of(launched - V2d(0, h));
    const auto y1 = pupil_of(launched + V2d(0, h));
    if (!x0 || !x1 || !y0 || !y1) return error <= kGoodEnough;
    V2d change = solved((*x1 - *x0) / (2 * h), (*y1 - *y0) / (2 * h), pupil - *now);
    if (!std::isfinite(change.x) || !std::isfinite(change.y)) return false;
    int halvings = 0;
    std::optional<V2d> next;
    for (; halvings < kMaxHalvings; ++halvings, change *= 0.5) {
      next = pupil_of(launched + change);
      if (next && (*next - pupil).length() < error) break;
    }
    if (halvings == kMaxHalvings) return error <= kGoodEnough;
    launched += change;
    now = next;
  }
  return (*now - pupil).length() <= kGoodEnough;
}

// Follows the chief ray from the axis outwards. The step is halved if Newton's method fails from the last
// chief ray.
bool Beam::find_chief(double field) {
  V2d launched(0, 0);
  double reached = 0;
  set_field(0);
  if (!solve({0, 0}, launched)) return false;
  double step = kFieldStep;
  while (reached < 1) {
    const double next = std::min(1.0, reached + step);
    V2d tried = launched;
    set_field(next * field);
    if (solve({0, 0}, tried)) {
      reached = next;
      launched = tried;
      step = std::min(2 * step, 2 * kFieldStep);
    } else if ((step /= 2) < kMinStep) {
      return false;
    }
  }
  chief_ = launched;
  return true;
}

std::optional<Beam> Beam::of(const SystemAt& at, double field, double stop_radius_mm) {
  Beam beam(at, stop_radius_mm);
  if (!beam.find_chief(field)) return std::nullopt;
  return beam;
}

std::optional<V2d> Beam::aim(const V2d& pupil) const {
  V2d launched = chief_;
  double reached = 0;
  double step = 1;
  while (reached < 1) {
    const double next = std::min(1.0, reached + step);
    V2d tried = launched;
    if (solve(next * pupil, tried)) {
      reached = next;
      launched = tried;
    } else if ((step /= 2) < 1.0 / 64) {
      return std::nullopt;
    }
  }
  return launched;
}

Imath::Box2d Beam::bounds() const {
  Imath::Box2d box(chief_);
  for (int i = 0; i < kRimRays; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRimRays;
    for (double fraction = 1; fraction > 0; fraction -= 0.125)  // the outermost ray that exists
      if (const auto launched = aim(fraction * V2d(std::cos(angle), std::sin(angle)))) {
        box.extendBy(*launched);
        break;
      }
  }
  const V2d room = 0.01 * box.size();  // margin for the rim between its rays
  return {box.min - room, box.max + room};
}

double stop_radius(const System& system) {
  if (system.aperture.kind == ApertureKind::stop) return system.aperture.value;
  System centred = system;
  for (Surface& surface : centred.surfaces) surface.decenter_mm = surface.tilt_deg = V2d(0, 0);
  const SystemAt at(centred, system.primary_nm());
  const FirstOrder first = first_order(at);
  const double diameter = system.aperture.kind == ApertureKind::entrance_pupil
                              ? system.aperture.value
                              : std::abs(first.focal_length_mm) / system.aperture.value;
  Ray ray{{0, diameter / 2, first.entrance_pupil_mm}, {0, 0, 1}};
  if (system.object_distance_mm) {
    const V3d object(0, 0, -*system.object_distance_mm);
    ray = {object, (ray.origin - object).normalized()};
  }
  const RayPath path = trace(at, ray, Apertures::ignored, system.stop + 1);
  if (path.hits.size() <= system.stop)
    throw Error(ErrorCode::scene, system.title,
                fmt::format("the axial ray of an entrance pupil of {:g} mm {}", diameter, reason(path)));
  return std::abs(local_point(at, system.stop, path.hits[system.stop].point).y);
}

}  // namespace abbe::lens

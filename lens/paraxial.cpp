#include "lens/paraxial.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace abbe::lens {
namespace {

// Maps (y, n u) before surface `first` to (y, n u) behind surface `last` - 1. With `onwards`, maps on to the
// vertex of `last` or to the image.
struct Matrix {
  double a = 1, b = 0, c = 0, d = 1;
};

Matrix matrix(const SystemAt& at, std::size_t first, std::size_t last, bool onwards) {
  Matrix m;
  for (std::size_t i = first; i < last; ++i) {
    const double power = at.surface(i).profile.vertex_curvature() * (at.n[i + 1] - at.n[i]);
    m.c -= power * m.a;
    m.d -= power * m.b;
    if (i + 1 == last && !onwards) break;
    const double reduced = at.surface(i).thickness_mm / at.n[i + 1];
    m.a += reduced * m.c;
    m.b += reduced * m.d;
  }
  return m;
}

double or_infinity(double mm) {
  return std::abs(mm) > kMaxMm ? std::copysign(std::numeric_limits<double>::infinity(), mm) : mm;
}

}  // namespace

std::vector<ParaxialHit> paraxial_trace(const SystemAt& at, double y, double u) {
  std::vector<ParaxialHit> hits;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double power = at.surface(i).profile.vertex_curvature() * (at.n[i + 1] - at.n[i]);
    u = (at.n[i] * u - y * power) / at.n[i + 1];
    hits.push_back({y, u});
    y += u * at.surface(i).thickness_mm;
  }
  return hits;
}

FirstOrder first_order(const SystemAt& at) {
  const std::size_t stop = at.system->stop;
  const Matrix all = matrix(at, 0, at.size(), false);
  const Matrix before = matrix(at, 0, stop, true);
  const Matrix behind = matrix(at, stop, at.size(), false);
  const double n_image = at.n.back();
  FirstOrder first{};
  first.focal_length_mm = or_infinity(-n_image / all.c);
  first.back_focus_mm = or_infinity(-n_image * all.a / all.c);
  first.front_focus_mm = or_infinity(all.d / all.c);
  const double far = std::numeric_limits<double>::infinity();
  const bool afocal = std::isinf(
      first.focal_length_mm);  // without power, a or d is 1 except for rounding, which would set the planes
  first.front_principal_mm = afocal ? far : or_infinity((all.d - 1) / all.c);
  first.rear_principal_mm = afocal ? far : or_infinity(n_image * (1 - all.a) / all.c);
  first.entrance_pupil_mm = or_infinity(before.b / before.a);
  first.entrance_magnification = 1 / (std::isinf(first.entrance_pupil_mm) ? 0 : before.a);
  first.stop_by_slope_mm = before.b;
  first.exit_pupil_mm = or_infinity(-n_image * behind.b / behind.d);
  first.exit_magnification = 1 / (std::isinf(first.exit_pupil_mm) ? 0 : behind.d);
  first.image_distance_mm = first.back_focus_mm;
  if (const auto distance = at.system->object_distance_mm) {
    const double y = all.a * *distance + all.b;  // of the ray that leaves the axis with slope 1
    const double nu = all.c * *distance + all.d;
    first.image_distance_mm = or_infinity(-n_image * y / nu);
    first.magnification = 1 / (std::isinf(first.image_distance_mm) ? 0 : nu);
  }
  return first;
}

// A ray that leaves the stop at (y_s, n u_s) passes the last vertex at y = a y_s + b n u_s. It passes the
// plane at z behind that vertex at x = A y_s + B n u_s, with A = a + z c/n', B = b + z d/n'. As ad - bc = 1,
//   y = x b/B + y_s (z/n')/B.
StopImage stop_image(const SystemAt& at, double distance_mm) {
  const Matrix behind = matrix(at, at.system->stop, at.size(), false);
  const double reduced = distance_mm / at.n.back();
  const double by_slope = behind.b + reduced * behind.d;
  return {reduced / by_slope, behind.b / by_slope};
}

ParaxialHit paraxial_chief_ray(const SystemAt& at, double field) {
  const FirstOrder first = first_order(at);
  if (const auto distance = at.system->object_distance_mm) {
    // A ray passes the stop at by_height y + by_slope u, wherever the entrance pupil is.
    const double by_height = 1 / first.entrance_magnification;
    const double by_slope = first.stop_by_slope_mm;
    const double scale = field / (by_height * *distance + by_slope);
    return {by_slope * scale, -by_height * scale};
  }
  const double slope = std::abs(field) < 90 ? std::tan(field * std::numbers::pi / 180)
                                            : std::numeric_limits<double>::quiet_NaN();
  return {-first.entrance_pupil_mm * slope, slope};
}

double paraxial_chief_height(const SystemAt& at, double field, double distance_mm) {
  const auto [y, u] = paraxial_chief_ray(at, field);
  const ParaxialHit last = paraxial_trace(at, y, u).back();
  return last.y + last.u * distance_mm;
}

}  // namespace abbe::lens

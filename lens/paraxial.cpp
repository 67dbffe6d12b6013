#include "lens/paraxial.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace abbe::lens {
namespace {

// (y, n u) behind surfaces first .. last - 1 of (y, n u) before them, and on to the vertex of `last` if it is
// one.
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
  first.focal_length_mm = -n_image / all.c;
  first.back_focus_mm = -n_image * all.a / all.c;
  first.front_focus_mm = all.d / all.c;
  first.front_principal_mm = first.front_focus_mm - 1 / all.c;
  first.rear_principal_mm = first.back_focus_mm - first.focal_length_mm;
  first.entrance_pupil_mm = before.b / before.a;
  first.entrance_magnification = 1 / before.a;
  first.stop_by_slope_mm = before.b;
  first.exit_pupil_mm = -n_image * behind.b / behind.d;
  first.exit_magnification = 1 / behind.d;
  first.image_distance_mm = first.back_focus_mm;
  if (const auto distance = at.system->object_distance_mm) {
    const double y = all.a * *distance + all.b;  // of the ray that leaves the axis at a slope of 1
    const double nu = all.c * *distance + all.d;
    first.image_distance_mm = -n_image * y / nu;
    first.magnification = 1 / nu;
  }
  return first;
}

double paraxial_slope(double direction_deg) {
  if (!(std::abs(direction_deg) < 90)) return std::numeric_limits<double>::quiet_NaN();
  return std::tan(direction_deg * std::numbers::pi / 180);
}

double paraxial_image_height(const SystemAt& at, const FirstOrder& first, double field) {
  if (at.system->object_distance_mm) return first.magnification * field;
  return first.focal_length_mm / at.n.back() * paraxial_slope(field);
}

}  // namespace abbe::lens

#include "spectral/color_temperature.h"

#include <algorithm>
#include <cmath>

#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

constexpr double kMaxScotopicEfficacy = 1700.06;  // K'm in air [lm/W]
constexpr double kMaxDuv = 0.05;
constexpr double kMinMired = 10;  // 1e6/T
constexpr double kMaxMired = 1000;
constexpr int kScanSteps = 99;
constexpr double kEndTolerance = 1e-6;  // relative; the search finds 1000 K within rounding

Uv1960 planckian_uv(double mired) {
  const ColorMatching& cmf = color_matching(Observer::cie1931);
  XYZ xyz{};
  constexpr SumRange kRange;
  for (int nm = kRange.low_nm; nm <= kRange.high_nm; ++nm) {
    const double power = planck_radiance(1e6 / mired, nm);
    xyz[0] += power * cmf.x(nm);
    xyz[1] += power * cmf.y(nm);
    xyz[2] += power * cmf.z(nm);
  }
  return uv_1960(xyz);
}

double distance(const Uv1960& a, const Uv1960& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

// Mired [1e6/K] of the nearest point of the Planckian locus: the best of a scan, refined by golden-section
// search.
double nearest_mired(const Uv1960& uv) {
  const auto separation = [&](double mired) { return distance(uv, planckian_uv(mired)); };
  const auto mired_at = [](int i) { return kMinMired + (kMaxMired - kMinMired) * i / kScanSteps; };
  int best = 0;
  double smallest = separation(mired_at(0));
  for (int i = 1; i <= kScanSteps; ++i)
    if (const double d = separation(mired_at(i)); d < smallest) {
      smallest = d;
      best = i;
    }
  // The search extends a little past both ends of the locus. A colour at an end is found, and a colour past
  // an end is not mistaken for it.
  double low = std::max(mired_at(best - 1), kMinMired / 2);
  double high = mired_at(best + 1);
  const double golden = (std::sqrt(5.0) - 1) / 2;
  while (high - low > 1e-9 * high) {
    const double a = high - golden * (high - low);
    const double b = low + golden * (high - low);
    (separation(a) < separation(b) ? high : low) = separation(a) < separation(b) ? b : a;
  }
  return (low + high) / 2;
}

const Curve& scotopic() {
  static const Curve curve = shipped_curve("observer", "scotopic_V_prime_cie1951");
  return curve;
}

}  // namespace

Uv1960 uv_1960(const XYZ& xyz) {
  const double sum = xyz[0] + 15 * xyz[1] + 3 * xyz[2];
  return {4 * xyz[0] / sum, 6 * xyz[1] / sum};
}

std::optional<ColorTemperature> color_temperature(const XYZ& xyz) {
  const Uv1960 uv = uv_1960(xyz);
  if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) return std::nullopt;
  const double mired = nearest_mired(uv);
  const Uv1960 nearest = planckian_uv(mired);
  const double separation = distance(uv, nearest);
  if (separation > kMaxDuv || mired < kMinMired * (1 - kEndTolerance) ||
      mired > kMaxMired * (1 + kEndTolerance))
    return std::nullopt;
  return ColorTemperature{1e6 / mired, std::copysign(separation, uv[1] - nearest[1])};
}

double luminous_efficacy(const Curve& light) {
  constexpr auto kLow = static_cast<double>(kVisibleRange.low_nm);
  constexpr auto kHigh = static_cast<double>(kVisibleRange.high_nm);
  // The trapezoidal rule is the mean of the two sums that omit one end each. It gives the integral of S too,
  // which is linear between whole nanometres.
  const Curve& v = color_matching(Observer::cie1931).y;
  const double luminous = (sum_product(light, v, {kVisibleRange.low_nm, kVisibleRange.high_nm - 1}) +
                           sum_product(light, v, {kVisibleRange.low_nm + 1, kVisibleRange.high_nm})) /
                          2;
  return kLuminousEfficacy * luminous / light.integral(kLow, kHigh);
}

double scotopic_photopic_ratio(const Curve& light, SumRange range) {
  return kMaxScotopicEfficacy / kLuminousEfficacy * sum_product(light, scotopic(), range) /
         sum_product(light, color_matching(Observer::cie1931).y, range);
}

}  // namespace abbe

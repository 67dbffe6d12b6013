#include "spectral/color_temperature.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/error.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

constexpr double kMaxScotopicEfficacy = 1700.06;  // K'm in air [lm/W]
constexpr double kFarthest = 0.05;
constexpr double kLeastMired = 10;  // 1e6/T
constexpr double kMostMired = 1000;
constexpr int kScanSteps = 99;
constexpr double kEndTolerance = 1e-6;  // Relative; the search finds 1000 K itself within rounding.

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

// The mired at which the locus is nearest: the best of a scan, then golden sections between its neighbours.
double nearest_mired(const Uv1960& uv) {
  const auto far = [&](double mired) { return distance(uv, planckian_uv(mired)); };
  const auto mired_at = [](int i) { return kLeastMired + (kMostMired - kLeastMired) * i / kScanSteps; };
  int best = 0;
  double least = far(mired_at(0));
  for (int i = 1; i <= kScanSteps; ++i)
    if (const double d = far(mired_at(i)); d < least) {
      least = d;
      best = i;
    }
  // The search also covers some of the locus outside the ends: a colour at an end is found, one outside is
  // not mistaken for it.
  double low = std::max(mired_at(best - 1), kLeastMired / 2);
  double high = mired_at(best + 1);
  const double golden = (std::sqrt(5.0) - 1) / 2;
  while (high - low > 1e-9 * high) {
    const double a = high - golden * (high - low);
    const double b = low + golden * (high - low);
    (far(a) < far(b) ? high : low) = far(a) < far(b) ? b : a;
  }
  return (low + high) / 2;
}

const Curve& scotopic() {
  static const Curve curve = [] {
    constexpr const char* kTable = "scotopic_V_prime_cie1951";
    Diagnostics diagnostics;
    auto loaded = load_curve("observer", kTable, {}, diagnostics);
    if (!loaded) throw Error(ErrorCode::input, kTable, diagnostics.text());
    return std::move(loaded->curve);
  }();
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
  const double far = distance(uv, nearest);
  if (far > kFarthest || mired < kLeastMired * (1 - kEndTolerance) ||
      mired > kMostMired * (1 + kEndTolerance))
    return std::nullopt;
  return ColorTemperature{1e6 / mired, std::copysign(far, uv[1] - nearest[1])};
}

double luminous_efficacy(const Curve& light) {
  constexpr auto kLow = static_cast<double>(kVisibleRange.low_nm);
  constexpr auto kHigh = static_cast<double>(kVisibleRange.high_nm);
  // The trapezoidal rule is the mean of the two sums that leave out one end each. The same rule gives the
  // integral of S, which is straight between the nanometres.
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

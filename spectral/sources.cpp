#include "spectral/sources.h"

#include <cmath>
#include <string>
#include <vector>

#include "io/error.h"
#include "spectral/library.h"

namespace abbe {
namespace {

struct DaylightComponents {
  Curve mean;
  Curve first;
  Curve second;
};

const DaylightComponents& daylight_components() {
  static const auto load = [](const std::string& column) {
    return shipped_curve("illuminant", "cie_daylight_components:" + column);
  };
  static const DaylightComponents components{load("S0"), load("S1"), load("S2")};
  return components;
}

double rounded(double value, double digits) {
  return std::round(value * digits) / digits;
}

}  // namespace

double planck_radiance(double temperature_K, double wavelength_nm) {
  // L = 2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1), per nm.
  const double lambda = wavelength_nm * 1e-9;
  const double first = 2 * kPlanck * kSpeedOfLight * kSpeedOfLight / std::pow(lambda, 5);
  return 1e-9 * first / std::expm1(photon_energy(wavelength_nm) / (kBoltzmann * temperature_K));
}

Curve planck(double temperature_K) {
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), planck_radiance(temperature_K, nm)});
  return Curve(std::move(knots));
}

Curve daylight(double cct_K) {
  const double t = 1e3 / cct_K;
  const double x = cct_K <= 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                 : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
  const double y = (-3.000 * x + 2.870) * x - 0.275;
  // S = S_0 + M_1 S_1 + M_2 S_2, with (x, y) on the daylight locus and M_1, M_2 from x and y.
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  // The CIE rounds both factors to three decimals, and its tables are computed that way.
  const double m1 = rounded((-1.3515 - 1.7703 * x + 5.9114 * y) / m, 1e3);
  const double m2 = rounded((0.0300 - 31.4424 * x + 30.0717 * y) / m, 1e3);
  const DaylightComponents& s = daylight_components();
  return sum(s.mean, sum(scaled(s.first, m1), scaled(s.second, m2)));
}

Curve band(double low_nm, double high_nm, double value) {
  if (!(low_nm < high_nm)) throw Error(ErrorCode::internal, "band", "needs low < high");
  return Curve(std::vector<Knot>{{low_nm, 0}, {low_nm, value}, {high_nm, value}, {high_nm, 0}});
}

Curve gaussian(double center_nm, double fwhm_nm, double peak) {
  if (!(fwhm_nm > 0)) throw Error(ErrorCode::internal, "gaussian", "needs a positive width");
  // 64 steps per width limit the interpolation error to 2e-4 of the peak. At 3.5 widths the value is below
  // 1e-14 of it.
  constexpr int kStepsPerWidth = 64;
  constexpr int kHalfSteps = kStepsPerWidth * 7 / 2;
  std::vector<Knot> knots;
  for (int i = -kHalfSteps; i <= kHalfSteps; ++i) {
    const double x = static_cast<double>(i) / kStepsPerWidth;
    const bool end = std::abs(i) == kHalfSteps;
    knots.push_back({center_nm + x * fwhm_nm, end ? 0 : peak * std::exp(-4 * std::log(2.0) * x * x)});
  }
  return Curve(std::move(knots));
}

Curve lines(std::span<const SpectralLine> lines) {
  Curve total;
  for (const SpectralLine& line : lines) {
    if (!(line.width_nm > 0)) throw Error(ErrorCode::internal, "line", "needs a positive width");
    total = sum(total, band(line.center_nm - line.width_nm / 2, line.center_nm + line.width_nm / 2,
                            line.power / line.width_nm));
  }
  return total;
}

}  // namespace abbe

#include "materials/index/dispersion.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "spectral/curve.h"

namespace abbe {
namespace {

// Squared wavelengths [um^2] at which terms of `f` diverge.
std::vector<double> poles_um2(const DispersionFormula& f) {
  const auto c = [&f](int i) { return dispersion::coefficient<double>(f, i); };
  std::vector<double> poles;
  const auto add = [&poles](double amplitude, double pole) {
    if (amplitude != 0 && pole > 0) poles.push_back(pole);
  };
  switch (f.id) {
    case 1:
    case 2:
    case 6:
      for (int i = 2; i + 1 <= f.terms; i += 2)
        add(c(i), f.id == 1 ? c(i + 1) * c(i + 1) : f.id == 2 ? c(i + 1) : 1 / c(i + 1));
      break;
    case 4:
      add(c(2), std::pow(c(4), c(5)));
      add(c(6), std::pow(c(8), c(9)));
      break;
    case 7:
      add(std::max(std::abs(c(2)), std::abs(c(3))), dispersion::kHerzberger);
      break;
    case 8:
    case 9:
      add(c(2), c(3));
      break;
    default:
      break;
  }
  return poles;
}

}  // namespace

std::optional<std::string> dispersion_fault(const DispersionFormula& f, double low_nm, double high_nm) {
  constexpr double kMargin = 1e-3;
  for (const double pole : poles_um2(f)) {
    if (low_nm * low_nm * 1e-6 < pole * (1 + kMargin) && high_nm * high_nm * 1e-6 > pole * (1 - kMargin))
      return fmt::format(
          "dispersion formula {} has a resonance at {:.6g} nm, inside its range [{:g}, {:g}] nm", f.id,
          1e3 * std::sqrt(pole), low_nm, high_nm);
  }
  const double last_nm = std::min<double>(high_nm, kMaxWavelengthNm);
  for (double nm = std::max<double>(low_nm, kMinWavelengthNm); nm <= last_nm; nm += 1) {
    const double n = dispersion_index(f, nm * 1e-3);
    if (!(n > 1))
      return fmt::format("dispersion formula {} gives n = {:.6g} at {:g} nm (allowed above 1)", f.id, n, nm);
  }
  return std::nullopt;
}

}  // namespace abbe

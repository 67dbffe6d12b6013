#pragma once

#include <cmath>
#include <complex>

namespace abbe {

/// Complex amplitudes of the reflected and transmitted electric fields, divided by the incident one. cos_i is
/// in [0, 1], eta the relative index, with Im eta > 0 if absorbing. r_p and r_s have opposite signs at normal
/// incidence. Fields vary in time as exp(-i omega t).
struct FresnelAmplitudes {
  std::complex<double> rs, rp, ts, tp;
};
[[nodiscard]] inline FresnelAmplitudes fresnel_amplitudes(double cos_i, std::complex<double> eta) {
  const double sin_i = std::sqrt((1 - cos_i) * (1 + cos_i));
  const std::complex<double> g =
      std::sqrt((eta - sin_i) * (eta + sin_i));  // eta cos_t, decaying into the medium
  const std::complex<double> p = eta * eta * cos_i;
  return {(cos_i - g) / (cos_i + g), (p - g) / (p + g), 2 * cos_i / (cos_i + g), 2.0 * eta * cos_i / (p + g)};
}

}  // namespace abbe

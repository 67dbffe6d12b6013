#pragma once

#include <concepts>

#include "spectral/sampled_spectrum.h"

namespace abbe {

/// a/b, or 0 if b is not positive, as for a fraction of a total that may be zero.
template <std::floating_point T>
[[nodiscard]] T quotient(T a, T b) {
  return b > 0 ? a / b : T(0);
}
/// The quotient at each wavelength.
[[nodiscard]] inline SampledSpectrum quotient(const SampledSpectrum& a, const SampledSpectrum& b) {
  return SampledSpectrum::map(a, b, quotient<float>);
}

}  // namespace abbe

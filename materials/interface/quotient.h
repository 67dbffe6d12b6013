#pragma once

#include <concepts>

#include "spectral/packet.h"

namespace abbe {

/// a/b, and 0 where b is not above 0: the share of a part in a whole that may be nothing.
template <std::floating_point T>
[[nodiscard]] T quotient(T a, T b) {
  return b > 0 ? a / b : T(0);
}
[[nodiscard]] inline SampledSpectrum quotient(const SampledSpectrum& a, const SampledSpectrum& b) {
  return SampledSpectrum::map(a, b, quotient<float>);
}

}  // namespace abbe

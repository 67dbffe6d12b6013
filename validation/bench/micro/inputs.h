#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <ImathVec.h>

#include "spectral/sampled_spectrum.h"

namespace abbe::micro {

/// Cyclic sequence of 4096 precomputed numbers in [0, 1), so that a benchmark does not time their generation.
/// Each object starts at the beginning of the same sequence.
class NumberCycle {
 public:
  NumberCycle() {
    for (std::size_t i = 0; i < kSize; ++i) {
      const double golden = static_cast<double>(i) * std::numbers::phi;
      numbers_[i] = static_cast<float>(golden - std::floor(golden)) * 0.999999F;
    }
  }
  [[nodiscard]] float next() { return numbers_[at_++ % kSize]; }
  /// The next two numbers, in their order.
  [[nodiscard]] Imath::V2f pair() {
    const float first = next();
    return {first, next()};
  }
  /// Eight wavelengths [nm] in steps of 40 nm, the first in [390, 430). Uses one number.
  [[nodiscard]] SampledSpectrum packet() {
    SampledSpectrum::Values nm;
    const float first = 390 + 40 * next();
    for (std::size_t lane = 0; lane < kLanes; ++lane) nm[lane] = first + 40.0F * static_cast<float>(lane);
    return SampledSpectrum(nm);
  }

 private:
  static constexpr std::size_t kSize = 4096;
  std::array<float, kSize> numbers_{};
  std::size_t at_ = 0;
};

}  // namespace abbe::micro

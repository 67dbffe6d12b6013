#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <ImathVec.h>

#include "spectral/packet.h"

namespace abbe::micro {

/// Cheap numbers in [0, 1) that go round, so that what is timed is not the making of them.
class Stream {
 public:
  Stream() {
    for (std::size_t i = 0; i < kSize; ++i) {
      const double golden = static_cast<double>(i) * std::numbers::phi;
      numbers_[i] = static_cast<float>(golden - std::floor(golden)) * 0.999999F;
    }
  }
  [[nodiscard]] float next() { return numbers_[at_++ % kSize]; }
  [[nodiscard]] Imath::V2f pair() {
    const float first = next();
    return {first, next()};
  }
  /// Eight wavelengths across the visible, 40 nm apart.
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

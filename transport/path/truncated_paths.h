#pragma once

#include <algorithm>
#include <cstdint>

#include "sensor/film/film.h"

namespace abbe {

/// Number of paths truncated at the maximum depth while they still carried light, and the sum of their
/// throughputs relative to those at the start. The sum is in fixed point, so that neither threads nor the
/// parts of a render change a bit of it.
struct TruncatedPaths {
  static constexpr int kUnitExponent = -40;  ///< Exponent of the power of two that is the unit of `sum`.
  static constexpr float kMaxThroughput = 0x1p40F;  ///< Larger throughputs are clamped to this.

  std::uint64_t paths = 0;
  Int128 sum = 0;  ///< In units of 2^kUnitExponent.

  /// Counts a path truncated with the throughput `throughput`, unless that is 0, negative or NaN.
  void count(float throughput) {
    if (!(throughput > 0)) return;
    ++paths;
    sum += to_fixed(static_cast<double>(std::min(throughput, kMaxThroughput)), kUnitExponent);
  }
  /// Sum of the relative throughputs.
  [[nodiscard]] double throughput() const { return from_fixed(sum, kUnitExponent); }

  TruncatedPaths& operator+=(const TruncatedPaths& other) {
    paths += other.paths;
    sum += other.sum;
    return *this;
  }
};

}  // namespace abbe

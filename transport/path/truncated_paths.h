#pragma once

#include <algorithm>
#include <cstdint>

#include "sensor/film/film.h"

namespace abbe {

/// Paths that were cut where they would have had one event more than a path may have, while they still
/// carried something; and the sum of that, each in units of what it had set out with. In fixed point, so that
/// neither threads nor the parts of a render change a bit of it.
struct TruncatedPaths {
  static constexpr int kUnitExponent = -40;
  static constexpr float kMost = 0x1p40F;  ///< More than this of a path counts as this.

  std::uint64_t paths = 0;
  Int128 sum = 0;  ///< In units of 2^kUnitExponent.

  /// Counts a path cut while it carried `throughput`; one that carries nothing is not counted.
  void count(float throughput) {
    if (!(throughput > 0)) return;
    ++paths;
    sum += to_fixed(static_cast<double>(std::min(throughput, kMost)), kUnitExponent);
  }
  [[nodiscard]] double throughput() const { return from_fixed(sum, kUnitExponent); }

  TruncatedPaths& operator+=(const TruncatedPaths& other) {
    paths += other.paths;
    sum += other.sum;
    return *this;
  }
};

}  // namespace abbe

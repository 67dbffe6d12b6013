#pragma once

#include <cstddef>

#include "spectral/curve.h"
#include "spectral/library.h"

namespace abbe {

/// What share of all that is counted may be left unknown without a word.
inline constexpr double kNegligibleShare = 1e-3;

/// How much of an integral lies beyond a range, and over how many straight pieces of its factors it was
/// summed.
struct ShareBeyond {
  double share = 0;
  std::size_t pieces = 0;
};

/// The share of the integral of |weight light| that lies below `low_nm` or above `high_nm`; 0 of a product
/// that is 0 everywhere. Pieces are summed only where the weight is not 0, and none where all of these lie
/// within the range.
[[nodiscard]] ShareBeyond share_beyond(const Curve& weight, const Curve& light, double low_nm,
                                       double high_nm);

/// The least range of wavelengths [nm] between knots of the curve, rounded outwards to whole ones, beyond
/// either end of which no more than `kNegligibleShare` of the integral of |curve| lies. Its ends are in the
/// other order for a curve that is 0 everywhere.
[[nodiscard]] NeededRange main_range(const Curve& curve);

/// The curve of a table if it went on beyond its first and last row as it ends there.
[[nodiscard]] Curve held_beyond(const NamedCurve& table);

}  // namespace abbe

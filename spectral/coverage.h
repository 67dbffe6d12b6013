#pragma once

#include <cstddef>

#include "spectral/curve.h"
#include "spectral/library.h"

namespace abbe {

/// Largest fraction of a response or light that may be unknown without a warning.
inline constexpr double kNegligibleFraction = 1e-3;

/// Fraction of an integral outside a range, and the number of linear pieces that were summed for it.
struct FractionOutside {
  double fraction = 0;     ///< In [0, 1].
  std::size_t pieces = 0;  ///< A measure of the work, for tests.
};

/// Fraction of the integral of |weight x light| below `low_nm` and above `high_nm`; 0 if the product is 0
/// everywhere. Sums only pieces with a nonzero weight, and none if all of them lie inside the range.
[[nodiscard]] FractionOutside fraction_outside(const Curve& weight, const Curve& light, double low_nm,
                                               double high_nm);

/// Smallest range [nm] between knots of the curve, rounded outwards to whole nanometres, that omits at most
/// `kNegligibleFraction` of the integral of |curve| at each end. For a curve that is 0 everywhere, the range
/// is {1100, 300}.
[[nodiscard]] NeededRange main_range(const Curve& curve);

/// Curve of a table, extrapolated by the constants of its first and last row, whatever `table.outside`
/// declares.
[[nodiscard]] Curve extrapolated(const NamedCurve& table);

}  // namespace abbe

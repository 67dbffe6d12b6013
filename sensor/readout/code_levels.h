#pragma once

#include <vector>

#include "sensor/readout/readout.h"

namespace abbe {

/// What a code tells of the signal that gave it, in DN of a straight response.
struct CodeLevel {
  double signal_dn;     ///< The middle of the signals that give it.
  double rounding_dn2;  ///< The variance that rounding to it adds: w^2/12 of their width w.
};

/// That of each 16-bit code that `linear_codes` makes of those of a read-out with a response curve: as steep
/// as the curve is there, one of the read-out's codes stands for more than 1 DN, or several for less. Codes
/// that it makes of none, and all without a curve, stand for themselves.
[[nodiscard]] std::vector<CodeLevel> code_levels(const Readout& readout);

}  // namespace abbe

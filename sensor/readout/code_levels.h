#pragma once

#include <vector>

#include "sensor/readout/readout.h"

namespace abbe {

/// Signal behind a code, in DN of a linear response.
struct CodeLevel {
  double signal_dn;     ///< Center of the signals that give the code.
  double rounding_dn2;  ///< Variance that rounding to it adds: w^2/12 for a width w.
};

/// Level of each 16-bit code after `linear_codes`. Depending on the slope of the response curve, one code of
/// the readout covers more than 1 DN, or several cover less. Codes that `linear_codes` does not produce, and
/// all codes without a response curve, are their own level.
[[nodiscard]] std::vector<CodeLevel> code_levels(const Readout& readout);

}  // namespace abbe

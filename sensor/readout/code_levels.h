#pragma once

#include <vector>

#include "sensor/readout/readout.h"

namespace abbe {

/// Signal behind a code, in DN of a linear response.
struct CodeLevel {
  double signal_dn;     ///< Center of the signals that give the code.
  double rounding_dn2;  ///< Variance that rounding to the code adds: w^2/12 for signals of a width w.
};

/// Level of each of the 65536 codes after `linear_codes`, indexed by the code. Depending on the slope of the
/// response curve, one code of the readout covers more than 1 DN, or several cover less. Codes that
/// `linear_codes` does not produce, and all codes without a response curve, are their own level, with a width
/// of 1 DN.
[[nodiscard]] std::vector<CodeLevel> code_levels(const Readout& readout);

}  // namespace abbe

#pragma once

#include "calibration/fit/response_problem.h"

namespace abbe {

/// Weight of the smoothness, a power of two from 1 to 4096, that best predicts exposures left out one at a
/// time. The problem is linearised at the unknowns, which remain unchanged. Whole exposures are left out,
/// because the samples of one have the error of its time in common, and similar patches have the same
/// rounding.
[[nodiscard]] double choose_roughness(const WeightedSamples& data, ResponseUnknowns& unknowns);

}  // namespace abbe

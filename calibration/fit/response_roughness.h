#pragma once

#include "calibration/fit/response_problem.h"

namespace abbe {

/// Weight of the smoothness that best predicts exposures left out one at a time, for the problem linearised
/// at the unknowns. Whole exposures are left out, because the samples of one have the error of its time in
/// common, and similar patches have the same rounding.
[[nodiscard]] double choose_roughness(const WeightedSamples& data, ResponseUnknowns& unknowns);

}  // namespace abbe

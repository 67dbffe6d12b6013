#pragma once

#include "calibration/fit/response_problem.h"

namespace abbe {

/// The roughness under which exposures left out one at a time are predicted best, the problem being
/// linearised at the unknowns. Whole exposures, since the samples of one share the error of its time, and
/// patches that look alike share their rounding.
[[nodiscard]] double choose_roughness(const WeightedSamples& data, ResponseUnknowns& unknowns);

}  // namespace abbe

#pragma once

#include <span>
#include <string>

#include "calibration/fit/response.h"
#include "calibration/fit/response_samples.h"

namespace abbe {

/// Throws Error{input} with this message about a response fit unless the condition holds.
void require_for_response(bool condition, const std::string& message);

/// Throws Error{input} unless a series has two times or more, all positive and at least 2 % between the
/// shortest and the longest, and its codes do not fall as time grows: from one time to the next by more than
/// 1 % of the patches' median, in three patches of four.
void require_usable_times(const ExposureSeries& series);

/// Throws Error{input} unless the samples that a fit has used determine its curve: unless between the lowest
/// and the highest of their codes its 95 % interval reaches less than a tenth of the exposure of the highest
/// to either side, and beyond them less than half of full scale.
void require_determined(const ResponseFit& fit, std::span<const ResponseSample> samples);

}  // namespace abbe

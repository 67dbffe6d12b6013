#pragma once

#include <span>
#include <string>

#include "calibration/fit/response.h"
#include "calibration/fit/response_samples.h"

namespace abbe {

/// Throws Error{input} about a response fit, with this message, unless `condition` holds.
void require_for_response(bool condition, const std::string& message);

/// Throws Error{input} unless
/// - the series has two times or more, all positive, and the longest is at least 1.02 times the shortest;
/// - codes do not fall as time grows.
///
/// Codes fall if three patches in four are darker at the next longer time and the median over the patches is
/// lower by 1 % or more.
void require_usable_times(const ExposureSeries& series);

/// Throws Error{input} unless the samples of a fit determine its curve. `samples` must not be empty; this is
/// not checked. Between their lowest
/// and highest code, the 95 % interval must extend less than a tenth of the highest code's exposure to either
/// side. Outside, it must extend less than half of full scale.
void require_determined(const ResponseFit& fit, std::span<const ResponseSample> samples);

}  // namespace abbe

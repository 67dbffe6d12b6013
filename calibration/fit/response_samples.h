#pragma once

#include <cstddef>
#include <vector>

#include "calibration/chart/exposure_series.h"

namespace abbe {

/// One usable code of an exposure series.
struct ResponseSample {
  std::size_t patch;  ///< Index of the patch in the series.
  double code;        ///< Code value in (0, 1).
  double deviation;   ///< Standard deviation of the code; 1 while unknown.
  double log_time;    ///< ln of the exposure time in seconds.
};

/// True if a code is so far from black and from full scale that noise of this standard deviation cannot have
/// clipped it: more than 8 deviations above 0 and 4 below 1.
[[nodiscard]] bool within_margins(double code, double deviation);

/// Usable codes of a series, patch by patch. Excluded are black and clipped codes. Codes of longer times than
/// one that clipped, and of shorter times than one that was black, are excluded too: only noise moves these
/// off the ends. `with_margins` also excludes codes that are not `within_margins` for known deviations.
[[nodiscard]] std::vector<ResponseSample> usable_samples(const ExposureSeries& series, bool with_margins);

}  // namespace abbe

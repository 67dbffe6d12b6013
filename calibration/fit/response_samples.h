#pragma once

#include <cstddef>
#include <vector>

#include "calibration/chart/exposure_series.h"

namespace abbe {

/// One usable code of an exposure series.
struct ResponseSample {
  std::size_t patch;
  double code;
  double deviation;  ///< Standard deviation of the code; 1 while unknown.
  double log_time;
};

/// True if a code is so far from black and from full scale that noise of this standard deviation cannot have
/// clipped it.
[[nodiscard]] bool within_margins(double code, double deviation);

/// Usable codes of a series. Excluded are black and clipped codes, codes of longer times than one that
/// clipped, and codes of shorter times than one that was black: only noise moves these off the ends.
/// `with_margins` also excludes codes within a few known deviations of either end.
[[nodiscard]] std::vector<ResponseSample> usable_samples(const ExposureSeries& series, bool with_margins);

}  // namespace abbe

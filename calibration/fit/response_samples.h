#pragma once

#include <cstddef>
#include <vector>

#include "calibration/chart/exposure_series.h"

namespace abbe {

/// One code of an exposure series that tells of the response.
struct ResponseSample {
  std::size_t patch;
  double code;
  double deviation;  ///< Standard deviation of the code; 1 where none is known yet.
  double log_time;
};

/// Whether noise of this deviation cannot have brought a code from black or from beyond full scale.
[[nodiscard]] bool within_margins(double code, double deviation);

/// The codes that are of use. Black and clipped ones say nothing of the exposure, nor do those of longer
/// times than one that clipped, or of shorter ones than one that was black: noise alone moves them off the
/// ends. With margins, codes within a few known deviations of either end are left out too.
[[nodiscard]] std::vector<ResponseSample> usable_samples(const ExposureSeries& series, bool with_margins);

}  // namespace abbe

#pragma once

#include <span>
#include <vector>

#include "calibration/fit/response_samples.h"

namespace abbe {

/// Standard deviation of Gaussian errors with these absolute values, of which there must be at least one. It
/// is estimated from their median, which a few outliers hardly change.
[[nodiscard]] double deviation_of(std::vector<double> sizes);

/// Noise of codes from dark to full scale, estimated from the residuals of a fit. It is used if a series does
/// not state deviations. Photon noise makes the errors of single pixels many times larger at bright codes
/// than at dark ones. A fit that assumed equal errors would be far too certain of the bright end.
class NoiseByCode {
 public:
  /// Estimates the noise from the absolute `errors` of the codes of `samples`, both in one order and not
  /// empty. The samples are divided into up to 12 groups of neighbouring codes, each with the standard
  /// deviation of its own errors.
  NoiseByCode(std::span<const ResponseSample> samples, std::span<const double> errors);

  /// Standard deviation of a code in [0, 1]: linear between the median codes of the groups, constant outside
  /// them.
  [[nodiscard]] double deviation(double code) const;

 private:
  struct Level {
    double code;
    double deviation;
  };
  std::vector<Level> levels_;  // by code
};

}  // namespace abbe

#pragma once

#include <span>
#include <vector>

#include "calibration/fit/response_samples.h"

namespace abbe {

/// The standard deviation that errors of these absolute sizes have if they are Gaussian; few outliers do not
/// tell.
[[nodiscard]] double deviation_of(std::vector<double> sizes);

/// How the errors of codes grow from the dark to full scale, told by the residuals of a fit where nothing
/// else tells: photons make those of a single pixel's bright codes many times those of its dark ones, and a
/// fit that takes them to be alike is far surer of the bright end than it may be.
class NoiseByCode {
 public:
  /// From the absolute `errors` of the codes of `samples`, as many: the samples in groups of neighbouring
  /// codes, each with the deviation of its own errors.
  NoiseByCode(std::span<const ResponseSample> samples, std::span<const double> errors);

  /// Standard deviation of a code in [0, 1]: linear between the middles of the groups, held beyond them.
  [[nodiscard]] double deviation(double code) const;

 private:
  struct Level {
    double code;
    double deviation;
  };
  std::vector<Level> levels_;  // by code
};

}  // namespace abbe

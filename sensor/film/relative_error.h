#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "sensor/film/film.h"

namespace abbe {

/// Floor of relMSE: the mean of (x - r)^2 / (r^2 + kUsualFloor * mean(r)^2) for values x and reference r.
inline constexpr double kUsualFloor = 0.01;

inline constexpr std::size_t kAllPlanes = std::numeric_limits<std::size_t>::max();

/// Deviation of a film from its expectation: standard deviations divided by means.
struct RelativeError {
  /// Median over the nonzero values; infinite if unknown.
  double median = std::numeric_limits<double>::infinity();
  double p95 = std::numeric_limits<double>::infinity();  ///< 95th percentile over them; infinite if unknown.
  /// Result of `frame_mean_error`. Unlike the median, it depends on a few bright pixels.
  double frame_mean = std::numeric_limits<double>::infinity();
  /// Largest relative error of the frame means of the planes that an error target names (`worst_mean_error`).
  /// Infinite unless the caller sets it.
  double worst_mean = std::numeric_limits<double>::infinity();
  /// Result of the function `few_samples`.
  std::optional<std::uint64_t> few_samples = {};
  /// Result of the function `hidden_noise`; 0 unless the caller sets it.
  double hidden_noise = 0;
};

/// False if the error is based on too few samples, or if a pilot predicts a larger one.
[[nodiscard]] inline bool is_known(const RelativeError& error) {
  return !error.few_samples && error.hidden_noise == 0;
}

/// Values that are not 0 in a pilot, by their index pixel * planes + plane; of very many, an evenly spread
/// subset. The pilot must be independent of the film to be judged. Only the first `intensity_planes` planes
/// count (all if there are fewer): the others are signed, and small where there is much light.
[[nodiscard]] std::vector<std::size_t> nonzero_values(const Film& pilot,
                                                      std::size_t intensity_planes = kAllPlanes);

/// Sets `frame_mean` and `few_samples` for the first `intensity_planes` planes. Sets the percentiles `median`
/// and `p95` of the relative errors of the `nonzero` values, which `quantiles_of_deviation` corrects for the
/// few replicates. A nonzero value that is 0 in the film has an infinite error. The percentiles are infinite
/// without nonzero values and with fewer than two filled replicates.
[[nodiscard]] RelativeError relative_error(const Film& film, std::span<const std::size_t> nonzero,
                                           std::size_t intensity_planes = kAllPlanes);

/// Largest relative error of the frame means of the first `planes` planes, except those with a mean of 0 or
/// less. Infinite if no plane remains, and with fewer than two filled replicates.
[[nodiscard]] double worst_mean_error(const Film& film, int planes);

/// Relative error of the frame mean of the first `intensity_planes` planes, taken together: sqrt(sum of the
/// variances of their means) / sqrt(sum of the squared means). Infinite for a film without light, and with
/// fewer than two filled replicates.
[[nodiscard]] double frame_mean_error(const Film& film, std::size_t intensity_planes = kAllPlanes);

/// Effective number of samples that carry half of the variance of the frame mean, for the first
/// `intensity_planes` planes together. Nothing if that number suffices to estimate a variance, and with fewer
/// than two filled replicates. Rare bright samples fall into different pixels, so only the pixels of the
/// largest variance V are counted. A pixel of mean M has n = M^2/V effective samples, about (sum w)^2 / sum
/// w^2 over its samples w [Kish1965]. This is 1 if one sample found all light of the pixel. It is large if
/// all samples found light there, so that a film of few bright pixels passes.
[[nodiscard]] std::optional<std::uint64_t> few_samples(const Film& film,
                                                       std::size_t intensity_planes = kAllPlanes);

/// Ratio of the standard error of the film's mean that a pilot predicts to the film's own, if significantly
/// larger than 1. Otherwise 0, and 0 with fewer than two filled replicates of either film. Only this ratio
/// reveals rare samples that the pilot found and the film did not. The pilot is a film of the same estimator
/// with independent random numbers. Its standard error scales with 1/sqrt(n) to a film of fewer samples per
/// pixel. It scales with n^(-3/2) to a film of more, as scrambled points do for a smooth integrand
/// [Pharr2023, sec. 8.2.2], so that the prediction is rather too small.
[[nodiscard]] double hidden_noise(const Film& film, const Film& pilot,
                                  std::size_t intensity_planes = kAllPlanes);

/// Quantiles of the true standard deviations at ascending `probabilities`, given positive and finite
/// estimates, at least one. The result has one value per probability in [0, 1], in the unit of the estimates.
/// Each estimate is the true value times chi/sqrt(f) with f degrees of freedom. The distribution of the true
/// values is the maximum-likelihood one [Laird1978], found by expectation maximisation in logarithmic steps
/// of 2.5 %.
[[nodiscard]] std::vector<double> quantiles_of_deviation(std::span<const double> estimates,
                                                         double degrees_of_freedom,
                                                         std::span<const double> probabilities);

}  // namespace abbe

#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "sensor/film/film.h"

namespace abbe {

/// relMSE of values x against r is the mean of (x - r)^2 over r^2 and this much of the squared mean of r.
inline constexpr double kUsualFloor = 0.01;

/// As many planes as a film has.
inline constexpr std::size_t kAllPlanes = std::numeric_limits<std::size_t>::max();

/// How far a film is from what endless samples would make of it: standard deviations over means.
struct RelativeError {
  double median = std::numeric_limits<double>::infinity();  ///< Of the lit values; infinite until known.
  double p95 = std::numeric_limits<double>::infinity();     ///< Their 95th percentile.
  /// Of the mean over the whole film, as `frame_mean_error` has it. Bright points that few pixels have weigh
  /// here, and in no median.
  double frame_mean = std::numeric_limits<double>::infinity();
  /// The largest of the means over the whole film of the planes that a target asks for, if it asks for some.
  double worst_mean = std::numeric_limits<double>::infinity();
  /// Samples that carry half of the variance of the film's mean, as `few_samples` counts them; nothing if
  /// these are enough for an estimate.
  std::optional<std::uint64_t> few_samples = {};
  /// Standard error of the film's mean that an independent pilot predicts, over the one that the film shows,
  /// if `hidden_noise` finds it significantly larger; 0 otherwise.
  double hidden_noise = 0;
};

/// False if the error of a film rests on too few samples, or a pilot predicts a larger one: its intervals are
/// too narrow.
[[nodiscard]] inline bool is_known(const RelativeError& error) {
  return !error.few_samples && error.hidden_noise == 0;
}

/// The values of a film that have light, by pixel times planes plus plane: those that are not 0 in a pilot,
/// which must be independent of the film to be judged; of very many, evenly spread ones. Only the first
/// `counting` planes are looked at: the others have a sign, and are small where there is much light.
[[nodiscard]] std::vector<std::size_t> lit_values(const Film& pilot, std::size_t counting = kAllPlanes);

/// Percentiles over the lit values, corrected for the few replicates by `quantiles_of_deviation`, and the
/// error of the mean of the first `counting` planes. A lit value that the film has no light in counts as
/// infinitely far off.
[[nodiscard]] RelativeError relative_error(const Film& film, std::span<const std::size_t> lit,
                                           std::size_t counting = kAllPlanes);

/// The largest relative error of the means over the whole film of the first so many planes, but for those
/// that are dark.
[[nodiscard]] double worst_mean_error(const Film& film, int planes);

/// Relative error of the mean over the whole film, its first `counting` planes, which count light, taken
/// together: root of the summed variances of their means over root of the summed squares. Infinite of a film
/// without light, and of samples in fewer than two replicates.
[[nodiscard]] double frame_mean_error(const Film& film, std::size_t counting = kAllPlanes);

/// Effective number of samples that carry half of the variance of the mean over the whole film, its first
/// `counting` planes taken together. Nothing if that number is large enough to estimate a variance, and with
/// samples in fewer than two replicates. Rare bright samples have pixels of their own, so only the pixels of
/// the largest variance V are counted. A pixel of mean M has n = M^2/V effective samples, about (sum w)^2 /
/// sum w^2 over its samples w [Kish1965]. This is 1 if a single sample found all light of the pixel. It is
/// large if all samples found light there, so that a film of few bright pixels passes.
[[nodiscard]] std::optional<std::uint64_t> few_samples(const Film& film, std::size_t counting = kAllPlanes);

/// Ratio of the standard error of the film's mean that a pilot predicts to the film's own, if it is
/// significantly larger than 1. 0 otherwise, and with samples in fewer than two replicates of either. Only
/// this ratio shows rare samples that the pilot has found and the film has not. The pilot is a film of the
/// same estimator with independent random numbers. Its standard error scales with 1/sqrt(n) to a film of
/// fewer samples per pixel. To one of more it scales with n^(-3/2), as scrambled points sum a smooth
/// integrand [Pharr2023, sec. 8.2.2], so that the prediction is rather too small.
[[nodiscard]] double hidden_noise(const Film& film, const Film& pilot, std::size_t counting = kAllPlanes);

/// Quantiles, at ascending `probabilities`, of standard deviations of which there are only estimates: each is
/// its true one times chi/sqrt(f), f the degrees of freedom, which spreads even equal ones. The distribution
/// of the true ones is that under which the estimates are likeliest [Laird1978], found by expectation
/// maximisation over logarithmic steps of 2.5 %. Estimates are positive and finite.
[[nodiscard]] std::vector<double> quantiles_of_deviation(std::span<const double> estimates,
                                                         double degrees_of_freedom,
                                                         std::span<const double> probabilities);

}  // namespace abbe

#include "sensor/film/relative_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <functional>
#include <numeric>
#include <queue>

#include "sensor/random.h"

namespace abbe {
namespace {

constexpr double kStep = 0.025;  // of the logarithm of a deviation
constexpr int kRounds = 200;
constexpr std::size_t kMaxValues = 1U << 17;

// Minimum number of samples for an estimate of the error of a mean.
constexpr std::size_t kEnoughSamples = 10;
// Negligible ratio of standard errors, and the standard deviations of its logarithm at which an excess is
// significant.
constexpr double kUsualRatio = 1.5;
constexpr double kSignificance = 3;

// Probability distribution over logarithms, in steps from `first` on.
struct Histogram {
  std::ptrdiff_t first;
  std::vector<double> mass;

  [[nodiscard]] std::ptrdiff_t size() const { return std::ssize(mass); }
  // The step of an element of `mass`.
  [[nodiscard]] double at(std::size_t i) const {
    return static_cast<double>(first + static_cast<std::ptrdiff_t>(i));
  }
};

std::ptrdiff_t step_of(double value) {
  return std::lround(std::log(value) / kStep);
}

Histogram histogram_of(std::span<const double> values) {
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  Histogram all{step_of(*lowest), {}};
  all.mass.resize(static_cast<std::size_t>(step_of(*highest) - all.first + 1));
  for (const double value : values)
    all.mass[static_cast<std::size_t>(step_of(value) - all.first)] += 1 / static_cast<double>(values.size());
  return all;
}

// Distribution of ln(chi/sqrt(f)), with density ~ e^(f x - f/2 e^(2x)), truncated where it is negligible.
Histogram spread_of_estimates(double f) {
  constexpr double kNegligible = 1e-5;  // relative to the mode, which is at 0
  const auto density = [f](std::ptrdiff_t i) {
    const double x = static_cast<double>(i) * kStep;
    return std::exp(f * x - f / 2 * (std::exp(2 * x) - 1));
  };
  Histogram spread{0, {}};
  while (density(spread.first - 1) > kNegligible) --spread.first;
  for (std::ptrdiff_t i = spread.first; i <= 0 || density(i) > kNegligible; ++i)
    spread.mass.push_back(density(i));
  const double sum = std::accumulate(spread.mass.begin(), spread.mass.end(), 0.0);
  for (double& mass : spread.mass) mass /= sum;
  return spread;
}

struct HistogramMoments {
  double mean = 0;
  double variance = 0;
};
HistogramMoments moments_of(const Histogram& of) {
  HistogramMoments m;
  for (std::size_t i = 0; i < of.mass.size(); ++i) m.mean += of.mass[i] * of.at(i);
  for (std::size_t i = 0; i < of.mass.size(); ++i) m.variance += of.mass[i] * std::pow(of.at(i) - m.mean, 2);
  return m;
}

// Initial estimate of the distribution whose sum with the noise `spread` is `observed`. It is a normal
// distribution with the differences of their means and variances, mixed with a uniform one so that no step of
// the histogram has probability 0.
Histogram initial_distribution(const Histogram& observed, const Histogram& spread) {
  constexpr double kUniformWeight = 0.05;
  const HistogramMoments all = moments_of(observed);
  const HistogramMoments noise = moments_of(spread);
  const double variance = std::max(all.variance - noise.variance, 0.25);
  Histogram estimate = observed;
  for (std::size_t i = 0; i < estimate.mass.size(); ++i)
    estimate.mass[i] = std::exp(-std::pow(estimate.at(i) - all.mean + noise.mean, 2) / (2 * variance));
  const double sum = std::accumulate(estimate.mass.begin(), estimate.mass.end(), 0.0);
  for (double& mass : estimate.mass)
    mass = (1 - kUniformWeight) * mass / sum + kUniformWeight / static_cast<double>(estimate.size());
  return estimate;
}

// One iteration of expectation maximisation. The mass of each step is multiplied by the mean ratio of
// observed to expected mass, weighted by `spread`. The loop over `spread` is the outer one, so that the inner
// loop runs along arrays.
void improve(Histogram& estimate, const Histogram& observed, const Histogram& spread) {
  const std::ptrdiff_t n = estimate.size();
  const auto each = [&](std::ptrdiff_t k,
                        auto visit) {  // visits the pairs of steps that element k of `spread` connects
    const std::ptrdiff_t by = spread.first + k;
    const double p = spread.mass[static_cast<std::size_t>(k)];
    const std::ptrdiff_t last = std::min(n, n - by);
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, -by); j < last; ++j)
      visit(static_cast<std::size_t>(j), static_cast<std::size_t>(j + by), p);
  };
  std::vector<double> ratio(estimate.mass.size());
  std::vector<double> mean(estimate.mass.size());
  for (std::ptrdiff_t k = spread.size(); k-- > 0;)
    each(k, [&](std::size_t j, std::size_t to, double p) { ratio[to] += p * estimate.mass[j]; });
  for (std::size_t i = 0; i < ratio.size(); ++i) ratio[i] = ratio[i] > 0 ? observed.mass[i] / ratio[i] : 0;
  for (std::ptrdiff_t k = 0; k < spread.size(); ++k)
    each(k, [&](std::size_t j, std::size_t to, double p) { mean[j] += p * ratio[to]; });
  double sum = 0;
  for (std::size_t j = 0; j < mean.size(); ++j) sum += estimate.mass[j] *= mean[j];
  for (double& mass : estimate.mass) mass /= sum;
}

// Quantile of a distribution that is uniform within each step.
double quantile(const Histogram& of, double probability) {
  double before = 0;
  double at = static_cast<double>(of.first) - 0.5;
  for (const double mass : of.mass) {
    if (before + mass >= probability) return std::exp(kStep * (at + (probability - before) / mass));
    before += mass;
    ++at;
  }
  return std::exp(kStep * at);
}

// Ratios of standard deviation to mean; values with a mean of 0 are in neither member.
struct Deviations {
  std::vector<double> noisy;
  std::size_t exact = 0;
};
Deviations deviations_of(const Film& film, std::span<const std::size_t> values) {
  constexpr double kRounding = 1e-7;  // smaller ratios are rounding errors of single precision
  const auto planes = static_cast<std::size_t>(film.channels());
  Deviations all;
  for (const std::size_t value : values) {
    const auto channel = static_cast<int>(value % planes);
    const double mean = std::abs(film.mean(value / planes, channel));
    if (!(mean > 0)) continue;
    const double deviation = std::sqrt(film.variance(value / planes, channel)) / mean;
    if (deviation <= kRounding)
      ++all.exact;
    else
      all.noisy.push_back(deviation);
  }
  return all;
}

// Variance of a pixel's mean, summed over its planes, and its effective number of samples.
struct NoisyPixel {
  double variance;
  double samples;

  auto operator<=>(const NoisyPixel&) const = default;
};
NoisyPixel noisy_pixel(const Film& film, std::size_t pixel, std::size_t intensity_planes) {
  const auto planes = static_cast<int>(std::min(intensity_planes, static_cast<std::size_t>(film.channels())));
  double variance = 0;
  double square = 0;
  for (int plane = 0; plane < planes; ++plane) {
    variance += film.variance(pixel, plane);
    square += std::pow(film.mean(pixel, plane), 2);
  }
  return {variance, variance > 0 ? square / variance : 0};
}

// Variance of the mean over the frame and its square, each summed over the planes, and the smallest degrees
// of freedom of a plane.
struct FrameNoise {
  double variance = 0;
  double square = 0;
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
};
FrameNoise frame_noise(const Film& film, std::size_t intensity_planes) {
  const auto planes = static_cast<int>(std::min(intensity_planes, static_cast<std::size_t>(film.channels())));
  FrameNoise noise;
  for (int plane = 0; plane < planes; ++plane) {
    const Film::Average average = film.average(plane);
    noise.variance += average.standard_error * average.standard_error;
    noise.square += average.mean * average.mean;
    noise.degrees_of_freedom = std::min(noise.degrees_of_freedom, average.degrees_of_freedom);
  }
  return noise;
}

}  // namespace

std::vector<std::size_t> nonzero_values(const Film& pilot, std::size_t intensity_planes) {
  const Crop crop = pilot.crop();
  const auto planes = static_cast<std::size_t>(pilot.channels());
  std::vector<std::size_t> nonzero;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x) {
      const std::size_t pixel = pilot.pixel_at(x, y);
      for (std::size_t plane = 0; plane < std::min(planes, intensity_planes); ++plane)
        if (pilot.mean(pixel, static_cast<int>(plane)) != 0) nonzero.push_back(pixel * planes + plane);
    }
  if (nonzero.size() <= kMaxValues) return nonzero;
  // Picks a random value from each of kMaxValues runs of equal length. A constant step could always select
  // the same plane, or the same colour of a mosaic.
  SplitMix64 random(0);
  for (std::size_t i = 0; i < kMaxValues; ++i) {
    const std::size_t first = i * nonzero.size() / kMaxValues;
    const std::size_t last = (i + 1) * nonzero.size() / kMaxValues;
    nonzero[i] = nonzero[first + random() % (last - first)];
  }
  nonzero.resize(kMaxValues);
  return nonzero;
}

std::vector<double> quantiles_of_deviation(std::span<const double> estimates, double degrees_of_freedom,
                                           std::span<const double> probabilities) {
  const Histogram observed = histogram_of(estimates);
  const Histogram spread = spread_of_estimates(degrees_of_freedom);
  Histogram fitted = initial_distribution(observed, spread);
  for (int round = 0; round < kRounds; ++round) improve(fitted, observed, spread);
  std::vector<double> quantiles;
  for (const double p : probabilities) quantiles.push_back(quantile(fitted, p));
  return quantiles;
}

std::optional<std::uint64_t> few_samples(const Film& film, std::size_t intensity_planes) {
  if (film.filled_replicates() < 2) return std::nullopt;
  std::priority_queue<NoisyPixel, std::vector<NoisyPixel>, std::greater<>> noisiest;
  double variance = 0;
  const Crop crop = film.crop();
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x) {
      const NoisyPixel pixel = noisy_pixel(film, film.pixel_at(x, y), intensity_planes);
      if (!(pixel.variance > 0)) continue;
      variance += pixel.variance;
      noisiest.push(pixel);
      if (noisiest.size() > kEnoughSamples) noisiest.pop();
    }
  double of_noisiest = 0;
  double samples = 0;
  std::vector<NoisyPixel> descending;
  for (; !noisiest.empty(); noisiest.pop()) descending.insert(descending.begin(), noisiest.top());
  for (const NoisyPixel& pixel : descending) {
    of_noisiest += pixel.variance;
    samples += pixel.samples;
    if (!(samples < kEnoughSamples)) return std::nullopt;
    if (of_noisiest >= variance / 2) return static_cast<std::uint64_t>(std::lround(samples));
  }
  return std::nullopt;
}

double hidden_noise(const Film& film, const Film& pilot, std::size_t intensity_planes) {
  const FrameNoise own = frame_noise(film, intensity_planes);
  const FrameNoise other = frame_noise(pilot, intensity_planes);
  if (!(own.degrees_of_freedom > 0 && other.degrees_of_freedom > 0 && own.variance > 0)) return 0;
  const double samples = film.samples() / pilot.samples();
  const double growth = samples > 1 ? std::pow(samples, 1.5) : std::sqrt(samples);
  const double ratio = std::sqrt(other.variance / own.variance) / growth;
  // The logarithm of an estimate with f degrees of freedom has a variance of about 1/(2f).
  const double spread = std::sqrt(0.5 / own.degrees_of_freedom + 0.5 / other.degrees_of_freedom);
  return ratio > kUsualRatio * std::exp(kSignificance * spread) ? ratio : 0;
}

double frame_mean_error(const Film& film, std::size_t intensity_planes) {
  const FrameNoise noise = frame_noise(film, intensity_planes);
  return film.filled_replicates() > 1 && noise.square > 0 ? std::sqrt(noise.variance / noise.square)
                                                          : std::numeric_limits<double>::infinity();
}

double worst_mean_error(const Film& film, int planes) {
  double worst = -1;
  for (int plane = 0; plane < planes; ++plane) {
    const Film::Average average = film.average(plane);
    if (average.mean > 0) worst = std::max(worst, average.standard_error / average.mean);
  }
  return film.filled_replicates() > 1 && worst >= 0 ? worst : std::numeric_limits<double>::infinity();
}

RelativeError relative_error(const Film& film, std::span<const std::size_t> nonzero,
                             std::size_t intensity_planes) {
  RelativeError error;
  error.frame_mean = frame_mean_error(film, intensity_planes);
  error.few_samples = few_samples(film, intensity_planes);
  if (nonzero.empty() || film.filled_replicates() < 2) return error;
  const Deviations deviations = deviations_of(film, nonzero);
  const auto noisy = static_cast<double>(deviations.noisy.size());
  constexpr std::array kProbabilities{0.5, 0.95};
  std::array<double, kProbabilities.size()> within;  // within the noisy values
  for (std::size_t i = 0; i < within.size(); ++i)
    within.at(i) =
        (kProbabilities.at(i) * static_cast<double>(nonzero.size()) - static_cast<double>(deviations.exact)) /
        std::max(noisy, 1.0);
  std::vector<double> quantiles(within.size(), 0.0);
  if (noisy > 0) quantiles = quantiles_of_deviation(deviations.noisy, film.filled_replicates() - 1, within);
  for (std::size_t i = 0; i < within.size(); ++i) {
    if (within.at(i) <= 0) quantiles[i] = 0;
    if (within.at(i) * std::max(noisy, 1.0) > noisy) quantiles[i] = std::numeric_limits<double>::infinity();
  }
  error.median = quantiles[0];
  error.p95 = quantiles[1];
  return error;
}

}  // namespace abbe

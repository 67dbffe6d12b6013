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
constexpr std::size_t kMostValues = 1U << 17;

// Fewer samples than these leave the error of a mean unknown.
constexpr std::size_t kEnoughSamples = 10;
// A negligible ratio of standard errors, and the standard deviations of its logarithm that make more
// significant.
constexpr double kUsualRatio = 1.5;
constexpr double kSignificance = 3;

// A distribution over logarithms, in steps from `first` on.
struct Histogram {
  std::ptrdiff_t first;
  std::vector<double> share;

  [[nodiscard]] std::ptrdiff_t size() const { return std::ssize(share); }
};

std::ptrdiff_t step_of(double value) {
  return std::lround(std::log(value) / kStep);
}

Histogram histogram_of(std::span<const double> values) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  Histogram all{step_of(*least), {}};
  all.share.resize(static_cast<std::size_t>(step_of(*greatest) - all.first + 1));
  for (const double value : values)
    all.share[static_cast<std::size_t>(step_of(value) - all.first)] += 1 / static_cast<double>(values.size());
  return all;
}

// The distribution of ln(chi/sqrt(f)), of density ~ e^(f x - f/2 e^(2x)), down to where it is negligible.
Histogram spread_of_estimates(double f) {
  constexpr double kNegligible = 1e-5;  // of the mode, which is at 0
  const auto density = [f](std::ptrdiff_t i) {
    const double x = static_cast<double>(i) * kStep;
    return std::exp(f * x - f / 2 * (std::exp(2 * x) - 1));
  };
  Histogram spread{0, {}};
  while (density(spread.first - 1) > kNegligible) --spread.first;
  for (std::ptrdiff_t i = spread.first; i <= 0 || density(i) > kNegligible; ++i)
    spread.share.push_back(density(i));
  const double sum = std::accumulate(spread.share.begin(), spread.share.end(), 0.0);
  for (double& share : spread.share) share /= sum;
  return spread;
}

struct HistogramMoments {
  double mean = 0;
  double variance = 0;
};
HistogramMoments moments_of(const Histogram& of) {
  HistogramMoments m;
  for (std::ptrdiff_t i = 0; i < of.size(); ++i)
    m.mean += of.share[static_cast<std::size_t>(i)] * static_cast<double>(of.first + i);
  for (std::ptrdiff_t i = 0; i < of.size(); ++i)
    m.variance +=
        of.share[static_cast<std::size_t>(i)] * std::pow(static_cast<double>(of.first + i) - m.mean, 2);
  return m;
}

// Where to start from: the normal distribution that explains mean and variance, and a little of everything,
// so that nothing is ruled out.
Histogram first_guess(const Histogram& seen, const Histogram& spread) {
  constexpr double kEverything = 0.05;
  const HistogramMoments all = moments_of(seen);
  const HistogramMoments noise = moments_of(spread);
  const double variance = std::max(all.variance - noise.variance, 0.25);
  Histogram guess = seen;
  for (std::ptrdiff_t i = 0; i < guess.size(); ++i)
    guess.share[static_cast<std::size_t>(i)] =
        std::exp(-std::pow(static_cast<double>(guess.first + i) - all.mean + noise.mean, 2) / (2 * variance));
  const double sum = std::accumulate(guess.share.begin(), guess.share.end(), 0.0);
  for (double& share : guess.share)
    share = (1 - kEverything) * share / sum + kEverything / static_cast<double>(guess.size());
  return guess;
}

// One round: each step's share times the mean, over what it spreads to, of seen over expected. The steps of
// the spread are the outer loop, so that the inner one runs along arrays.
void improve(Histogram& guess, const Histogram& seen, const Histogram& spread) {
  const std::ptrdiff_t n = guess.size();
  const auto each = [&](std::ptrdiff_t k, auto visit) {  // of the steps that spread by the kth of `spread`
    const std::ptrdiff_t by = spread.first + k;
    const double p = spread.share[static_cast<std::size_t>(k)];
    const std::ptrdiff_t last = std::min(n, n - by);
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, -by); j < last; ++j)
      visit(static_cast<std::size_t>(j), static_cast<std::size_t>(j + by), p);
  };
  std::vector<double> ratio(guess.share.size());
  std::vector<double> mean(guess.share.size());
  for (std::ptrdiff_t k = spread.size(); k-- > 0;)
    each(k, [&](std::size_t j, std::size_t to, double p) { ratio[to] += p * guess.share[j]; });
  for (std::size_t i = 0; i < ratio.size(); ++i) ratio[i] = ratio[i] > 0 ? seen.share[i] / ratio[i] : 0;
  for (std::ptrdiff_t k = 0; k < spread.size(); ++k)
    each(k, [&](std::size_t j, std::size_t to, double p) { mean[j] += p * ratio[to]; });
  double sum = 0;
  for (std::size_t j = 0; j < mean.size(); ++j) sum += guess.share[j] *= mean[j];
  for (double& share : guess.share) share /= sum;
}

// Within a step the distribution is even.
double quantile(const Histogram& of, double probability) {
  double before = 0;
  double at = static_cast<double>(of.first) - 0.5;
  for (const double share : of.share) {
    if (before + share >= probability) return std::exp(kStep * (at + (probability - before) / share));
    before += share;
    ++at;
  }
  return std::exp(kStep * at);
}

// Estimates of standard deviation over mean of some values; those without a mean are in neither.
struct Deviations {
  std::vector<double> noisy;
  std::size_t exact = 0;
};
Deviations deviations_of(const Film& film, std::span<const std::size_t> values) {
  constexpr double kRounding = 1e-7;  // what is steadier has no noise but that of single precision
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

// Variance of a pixel's mean, its planes taken together, and the effective number of samples behind it.
struct NoisyPixel {
  double variance;
  double samples;

  auto operator<=>(const NoisyPixel&) const = default;
};
NoisyPixel noisy_pixel(const Film& film, std::size_t pixel, std::size_t counting) {
  const auto planes = static_cast<int>(std::min(counting, static_cast<std::size_t>(film.channels())));
  double variance = 0;
  double square = 0;
  for (int plane = 0; plane < planes; ++plane) {
    variance += film.variance(pixel, plane);
    square += std::pow(film.mean(pixel, plane), 2);
  }
  return {variance, variance > 0 ? square / variance : 0};
}

// The mean over the whole film, its planes taken together: sums of the variances and of the squares of their
// means, and the fewest degrees of freedom of a plane.
struct FrameNoise {
  double variance = 0;
  double square = 0;
  double degrees_of_freedom = std::numeric_limits<double>::infinity();
};
FrameNoise frame_noise(const Film& film, std::size_t counting) {
  const auto planes = static_cast<int>(std::min(counting, static_cast<std::size_t>(film.channels())));
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

std::vector<std::size_t> lit_values(const Film& pilot, std::size_t counting) {
  const Crop crop = pilot.crop();
  const auto planes = static_cast<std::size_t>(pilot.channels());
  std::vector<std::size_t> lit;
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x) {
      const std::size_t pixel = pilot.pixel_at(x, y);
      for (std::size_t plane = 0; plane < std::min(planes, counting); ++plane)
        if (pilot.mean(pixel, static_cast<int>(plane)) != 0) lit.push_back(pixel * planes + plane);
    }
  if (lit.size() <= kMostValues) return lit;
  // One of each of as many runs of equal length, anywhere in it: an even step would keep to one plane, or to
  // one colour of a mosaic, wherever it is a multiple of their number.
  SplitMix64 random(0);
  for (std::size_t i = 0; i < kMostValues; ++i) {
    const std::size_t first = i * lit.size() / kMostValues;
    const std::size_t last = (i + 1) * lit.size() / kMostValues;
    lit[i] = lit[first + random() % (last - first)];
  }
  lit.resize(kMostValues);
  return lit;
}

std::vector<double> quantiles_of_deviation(std::span<const double> estimates, double degrees_of_freedom,
                                           std::span<const double> probabilities) {
  const Histogram seen = histogram_of(estimates);
  const Histogram spread = spread_of_estimates(degrees_of_freedom);
  Histogram found = first_guess(seen, spread);
  for (int round = 0; round < kRounds; ++round) improve(found, seen, spread);
  std::vector<double> quantiles;
  for (const double p : probabilities) quantiles.push_back(quantile(found, p));
  return quantiles;
}

std::optional<std::uint64_t> few_samples(const Film& film, std::size_t counting) {
  if (film.filled_replicates() < 2) return std::nullopt;
  std::priority_queue<NoisyPixel, std::vector<NoisyPixel>, std::greater<>> noisiest;
  double variance = 0;
  const Crop crop = film.crop();
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x) {
      const NoisyPixel pixel = noisy_pixel(film, film.pixel_at(x, y), counting);
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

double hidden_noise(const Film& film, const Film& pilot, std::size_t counting) {
  const FrameNoise own = frame_noise(film, counting);
  const FrameNoise other = frame_noise(pilot, counting);
  if (!(own.degrees_of_freedom > 0 && other.degrees_of_freedom > 0 && own.variance > 0)) return 0;
  const double samples = film.samples() / pilot.samples();
  const double growth = samples > 1 ? std::pow(samples, 1.5) : std::sqrt(samples);
  const double ratio = std::sqrt(other.variance / own.variance) / growth;
  // The logarithm of an estimate of f degrees has the variance 1/(2f), about.
  const double spread = std::sqrt(0.5 / own.degrees_of_freedom + 0.5 / other.degrees_of_freedom);
  return ratio > kUsualRatio * std::exp(kSignificance * spread) ? ratio : 0;
}

double frame_mean_error(const Film& film, std::size_t counting) {
  const FrameNoise noise = frame_noise(film, counting);
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

RelativeError relative_error(const Film& film, std::span<const std::size_t> lit, std::size_t counting) {
  RelativeError error;
  error.frame_mean = frame_mean_error(film, counting);
  error.few_samples = few_samples(film, counting);
  if (lit.empty() || film.filled_replicates() < 2) return error;
  const Deviations deviations = deviations_of(film, lit);
  const auto noisy = static_cast<double>(deviations.noisy.size());
  constexpr std::array kProbabilities{0.5, 0.95};
  std::array<double, kProbabilities.size()> within;  // the noisy ones
  for (std::size_t i = 0; i < within.size(); ++i)
    within.at(i) =
        (kProbabilities.at(i) * static_cast<double>(lit.size()) - static_cast<double>(deviations.exact)) /
        std::max(noisy, 1.0);
  std::vector<double> found(within.size(), 0.0);
  if (noisy > 0) found = quantiles_of_deviation(deviations.noisy, film.filled_replicates() - 1, within);
  for (std::size_t i = 0; i < within.size(); ++i) {
    if (within.at(i) <= 0) found[i] = 0;
    if (within.at(i) * std::max(noisy, 1.0) > noisy) found[i] = std::numeric_limits<double>::infinity();
  }
  error.median = found[0];
  error.p95 = found[1];
  return error;
}

}  // namespace abbe

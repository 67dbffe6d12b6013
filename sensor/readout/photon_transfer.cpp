#include "sensor/readout/photon_transfer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {
namespace {

constexpr double kRoundingVariance = 1.0 / 12;  // DN^2
constexpr double kFitted = 0.7;                 // of the signal at saturation
constexpr double kPatternsAt = 0.5;
constexpr double kLeastKnown = 0.5;  // relative error from which a gain is none
constexpr const char* kNoLight =
    "no lit pair between darkness and saturation: their codes scatter no more than those of the dark pairs";

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::input, "photon transfer", what);
}

// Of a pair [DN, DN^2]: mean, variance from one exposure to the next, variance over the pixels without it,
// and the squared standard error of the temporal one [DN^4].
struct PairMoments {
  double exposure_s;
  double mean;
  double temporal;
  double spatial;
  double temporal_error2;
};

PairMoments moments(const FlatPair& pair) {
  const auto n = static_cast<double>(pair.first.size());
  if (pair.first.size() < 2 || pair.first.size() != pair.second.size()) refuse("a pair of unequal frames");
  double sum = 0;
  double difference = 0;
  double squares = 0;
  double difference_squares = 0;
  double cubes = 0;
  double fourths = 0;
  for (std::size_t i = 0; i < pair.first.size(); ++i) {
    const double s = static_cast<double>(pair.first[i]) + pair.second[i];
    const double d = static_cast<double>(pair.first[i]) - pair.second[i];
    sum += s;
    difference += d;
    squares += s * s;
    difference_squares += d * d;
    cubes += d * d * d;
    fourths += d * d * d * d;
  }
  const double temporal = (difference_squares - difference * difference / n) / (n - 1) / 2;
  const double of_means = (squares - sum * sum / n) / (n - 1) / 4;
  const double m = difference / n;
  const double fourth = (fourths - 4 * m * cubes + 6 * m * m * difference_squares) / n - 3 * m * m * m * m;
  // The variance of a variance is (mu_4 - sigma^4)/n; that of the difference is twice the temporal one.
  const double error2 = std::max(0.0, fourth / 4 - temporal * temporal) / n;
  return {pair.exposure_s, sum / n / 2, temporal, of_means - temporal / 2, error2};
}

std::vector<PairMoments> all_moments(std::span<const FlatPair> pairs) {
  std::vector<PairMoments> all;
  std::transform(pairs.begin(), pairs.end(), std::back_inserter(all), moments);
  return all;
}

// Least squares of a moment over the exposure time.
struct Line {
  double at_zero;
  double slope;
  [[nodiscard]] double at(double x) const { return at_zero + slope * x; }
};
Line fitted(const std::vector<PairMoments>& points, double PairMoments::*value) {
  const auto n = static_cast<double>(points.size());
  double x = 0;
  double y = 0;
  double xx = 0;
  double xy = 0;
  for (const PairMoments& p : points) {
    x += p.exposure_s;
    y += p.*value;
    xx += p.exposure_s * p.exposure_s;
    xy += p.exposure_s * p.*value;
  }
  const double spread = n * xx - x * x;
  if (!(spread > 0)) refuse("the dark pairs are of one exposure time only: the dark current needs two");
  const double slope = (n * xy - x * y) / spread;
  return {(y - slope * x) / n, slope};
}

// What the value at x of the line through the points is moved by, for each point that is moved by 1.
std::vector<double> line_weights(const std::vector<PairMoments>& points, double x) {
  const auto n = static_cast<double>(points.size());
  double middle = 0;
  for (const PairMoments& p : points) middle += p.exposure_s / n;
  double spread = 0;
  for (const PairMoments& p : points) spread += (p.exposure_s - middle) * (p.exposure_s - middle);
  std::vector<double> weights;
  for (const PairMoments& p : points)
    weights.push_back(1 / n + (x - middle) * (p.exposure_s - middle) / spread);
  return weights;
}

// K = sum(s^2) / sum(s v): a pair's variance moves ln K by -s / sum(s v), one of darkness through the line.
struct RelativeErrors {
  double gain;
  std::optional<double> read_noise;
};
RelativeErrors relative_errors(const std::vector<PairMoments>& dark,
                               const std::vector<PairMoments>& fitted_pairs, const Line& dark_mean,
                               double products, double read_variance) {
  std::vector<double> moved(dark.size(), 0);
  double lit_part = 0;
  for (const PairMoments& m : fitted_pairs) {
    const double by = (m.mean - dark_mean.at(m.exposure_s)) / products;
    lit_part += by * by * m.temporal_error2;
    const std::vector<double> weights = line_weights(dark, m.exposure_s);
    for (std::size_t j = 0; j < dark.size(); ++j) moved[j] += by * weights[j];
  }
  const std::vector<double> at_zero = line_weights(dark, 0);
  double gain = lit_part;
  double noise = lit_part;
  for (std::size_t j = 0; j < dark.size(); ++j) {
    gain += moved[j] * moved[j] * dark[j].temporal_error2;
    const double both = moved[j] + at_zero[j] / 2 / read_variance;
    noise += both * both * dark[j].temporal_error2;
  }
  return {std::sqrt(gain), read_variance > 0 ? std::optional(std::sqrt(noise)) : std::nullopt};
}

}  // namespace

PhotonTransfer photon_transfer(std::span<const FlatPair> dark_pairs, std::span<const FlatPair> lit_pairs,
                               int bits) {
  const std::vector<PairMoments> dark = all_moments(dark_pairs);
  const std::vector<PairMoments> lit = all_moments(lit_pairs);
  if (dark.empty() || lit.empty()) refuse("no dark or no lit pairs");
  const Line dark_mean = fitted(dark, &PairMoments::mean);
  const Line dark_variance = fitted(dark, &PairMoments::temporal);
  const auto signal = [&](const PairMoments& m) { return m.mean - dark_mean.at(m.exposure_s); };

  // Saturation is where the variance is largest.
  const auto by = [](auto value) {
    return [value](const PairMoments& a, const PairMoments& b) { return value(a) < value(b); };
  };
  const auto variance = [](const PairMoments& m) { return m.temporal; };
  const double saturation = signal(*std::max_element(lit.begin(), lit.end(), by(variance)));
  double products = 0;
  double squares = 0;
  std::vector<PairMoments> below;
  for (const PairMoments& m : lit)
    if (signal(m) <= kFitted * saturation) {
      below.push_back(m);
      products += signal(m) * (m.temporal - dark_variance.at(m.exposure_s));
      squares += signal(m) * signal(m);
    }
  if (below.empty())
    refuse(fmt::format(
        "no lit pair is below {} of the signal where the sensor saturates, taken to be the {:.5g} "
        "DN where the codes scatter most: weaker light is needed beside it ({} lit pair{} given)",
        kFitted, saturation, lit.size(), lit.size() == 1 ? "" : "s"));
  if (!(products > 0)) refuse(kNoLight);
  const double gain = squares / products;
  const double read_variance = dark_variance.at_zero - kRoundingVariance;
  const RelativeErrors errors = relative_errors(dark, below, dark_mean, products, read_variance);
  if (errors.gain > kLeastKnown) refuse(kNoLight);

  const auto from_half = [&](const PairMoments& m) { return std::abs(signal(m) - kPatternsAt * saturation); };
  const PairMoments& half = *std::min_element(lit.begin(), lit.end(), by(from_half));
  const PairMoments& shortest =
      *std::min_element(dark.begin(), dark.end(), by([](const PairMoments& m) { return m.exposure_s; }));
  const PairMoments& brightest = *std::max_element(lit.begin(), lit.end(), by(signal));
  const auto root = [](double x) { return std::sqrt(std::max(0.0, x)); };
  const double highest_code = static_cast<double>((1U << bits) - 1);
  // In a full well all pixels hold the same, so that the variance is far below that of the light.
  const bool full =
      brightest.temporal - dark_variance.at(brightest.exposure_s) < signal(brightest) / gain / 2;
  std::optional<double> full_well;
  if (full && brightest.mean < highest_code - 1) full_well = (brightest.mean - dark_mean.at_zero) * gain;
  std::vector<TransferPoint> points;
  for (const PairMoments& m : lit) points.push_back({signal(m), m.temporal - dark_variance.at(m.exposure_s)});
  const double read_noise = root(read_variance) * gain;
  return {gain,
          read_noise,
          dark_mean.slope * gain,
          100 * root(half.spatial - shortest.spatial) / signal(half),
          root(shortest.spatial) * gain,
          full_well,
          std::move(points),
          errors.gain * gain,
          errors.read_noise ? std::optional(*errors.read_noise * read_noise) : std::nullopt};
}

}  // namespace abbe

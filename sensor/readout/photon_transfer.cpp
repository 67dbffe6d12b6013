#include "sensor/readout/photon_transfer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {

namespace {
constexpr double kLowest = 0.05;  // fraction of saturation where the linearity range begins
constexpr double kHighest = 0.95;
constexpr double kSteadyLight = 10;  // percent; above it the exposure times do not determine the light
constexpr std::size_t kMinTimes = 4;
constexpr std::size_t kMinSignals = 3;

// A weighted point for a line fit.
struct Sample {
  double x, y, weight;
};

// Line y = at_zero + slope x fitted by weighted least squares.
struct WeightedLine {
  double at_zero, slope;
  double at_zero_variance, slope_variance;  // valid if the weights are inverse variances
};
std::optional<WeightedLine> fitted_line(const std::vector<Sample>& samples) {
  double w = 0;
  double wx = 0;
  double wy = 0;
  double wxx = 0;
  double wxy = 0;
  for (const Sample& s : samples) {
    w += s.weight;
    wx += s.weight * s.x;
    wy += s.weight * s.y;
    wxx += s.weight * s.x * s.x;
    wxy += s.weight * s.x * s.y;
  }
  const double determinant = w * wxx - wx * wx;
  if (!(determinant > 1e-12 * w * wxx)) return std::nullopt;
  return WeightedLine{(wxx * wy - wx * wxy) / determinant, (w * wxy - wx * wy) / determinant,
                      wxx / determinant, w / determinant};
}

std::size_t distinct(std::span<const TransferPoint> points, double TransferPoint::*value) {
  std::set<double> unique_values;
  for (const TransferPoint& p : points) unique_values.insert(p.*value);
  return unique_values.size();
}

// Relative curvature b of y/t = c (1 + b t) over the exposure time, and its standard error from the residuals
// of the parabola.
std::optional<RelativeBias> curvature_over_time(std::span<const TransferPoint> points) {
  std::vector<Sample> samples;
  for (const TransferPoint& p : points) samples.push_back({p.exposure_s, p.signal_dn / p.exposure_s, 1});
  const auto line = fitted_line(samples);
  if (!line || !(line->at_zero > 0)) return std::nullopt;
  double squares = 0;
  for (const Sample& s : samples) squares += std::pow(s.y - line->at_zero - line->slope * s.x, 2);
  const double spread = std::sqrt(squares / std::max(1.0, static_cast<double>(points.size()) - 2));
  return RelativeBias{line->slope / line->at_zero, spread * std::sqrt(line->slope_variance) / line->at_zero};
}

// Relative bias of the gain for a curvature b over the exposure time.
double bias_of(std::span<const TransferPoint> points, double curvature) {
  double squares = 0;
  double products = 0;
  for (const TransferPoint& p : points) {
    const double light = p.exposure_s;
    const double signal = light * (1 + curvature * light);
    const double slope = 1 + 2 * curvature * light;
    squares += signal * signal;
    products += signal * slope * slope * light;
  }
  return squares / products - 1;
}

std::optional<RelativeBias> bias_by_times(std::span<const TransferPoint> points) {
  const auto curvature = curvature_over_time(points);
  if (!curvature) return std::nullopt;
  const double bias = bias_of(points, curvature->value);
  const double moved = bias_of(points, curvature->value + curvature->standard_error);
  return RelativeBias{bias, std::abs(moved - bias)};
}

std::optional<RelativeBias> bias_by_variances(std::span<const TransferPoint> points) {
  std::vector<Sample> samples;
  double squares = 0;
  double products = 0;
  for (const TransferPoint& p : points) {
    if (!(p.variance_error2 > 0)) return std::nullopt;
    const double y2 = p.signal_dn * p.signal_dn;
    samples.push_back({p.signal_dn, p.variance_dn2 / p.signal_dn, y2 / p.variance_error2});
    squares += y2;
    products += p.signal_dn * p.variance_dn2;
  }
  const auto line = fitted_line(samples);
  if (!line || !(line->at_zero > 0)) return std::nullopt;
  return RelativeBias{squares / products * line->at_zero - 1,
                      std::sqrt(line->at_zero_variance) / line->at_zero};
}

constexpr double kFitted = 0.7;  // fraction of saturation up to which K is fitted
constexpr double kPatternsAt = 0.5;
constexpr double kFull = 0.9;           // fraction of the signal of the brightest pair, if that is full
constexpr double kMaxGainError = 0.5;   // relative error at which no gain can be determined
constexpr double kPatternNoise = 0.25;  // largest noise of extrapolated darkness, relative to the pattern
constexpr const char* kNoLight =
    "no illuminated pair lies between darkness and saturation: their codes scatter no more than those of the "
    "dark pairs";

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::input, "photon transfer", what);
}

[[noreturn]] void refuse_bright_pairs(double saturation_dn, std::size_t illuminated_pairs) {
  refuse(
      fmt::format("no illuminated pair is below {} of the saturation signal, taken as the {:.5g} DN where "
                  "the codes scatter most: add pairs at weaker light ({} illuminated pair{} given)",
                  kFitted, saturation_dn, illuminated_pairs, illuminated_pairs == 1 ? "" : "s"));
}

// Moments of a pair [DN, DN^2]: mean, temporal variance without rounding, spatial variance without both, and
// the squared standard error of the temporal variance [DN^4].
struct PairMoments {
  double exposure_s;
  double mean;
  double temporal;
  double spatial;
  double temporal_error2;
};

// Bound on the deviation of the rounding variance from w^2/12, for steps w and pixels with the temporal
// variance t and the total variance v. It depends on the position of their mean between two codes: +- w^2 (4
// v/w^2 + 1/pi^2) exp(-2 pi^2 v/w^2), the first term of a Fourier series. If patterns spread the pixels over
// the codes, up to w^2/12 exp(-4 pi^2 t/w^2) is the same in both exposures. Both are below 1.2e-8 w^2 for t
// >= w^2, which no number of pixels can detect.
double rounding_error(double step2, double temporal, double spatial) {
  constexpr double kPi2 = std::numbers::pi * std::numbers::pi;
  const double t = std::max(0.0, temporal / step2);
  const double v = t + std::max(0.0, spatial / step2);
  if (t >= 1) return 0;
  return step2 * std::max((4 * v + 1 / kPi2) * std::exp(-2 * kPi2 * v), std::exp(-4 * kPi2 * t) / 12);
}

// Sums over the pixels of a pair: both frames, and powers of their differences.
struct PairSums {
  double sum = 0;
  double squares = 0;
  double difference = 0;
  double difference_squares = 0;
  double cubes = 0;
  double fourths = 0;
  double rounding = 0;  // of the mean of both frames
};

PairSums pair_sums(const FlatPair& pair, const std::vector<CodeLevel>& levels) {
  PairSums all;
  for (std::size_t i = 0; i < pair.first.size(); ++i) {
    const CodeLevel& a = levels[pair.first[i]];
    const CodeLevel& b = levels[pair.second[i]];
    const double s = a.signal_dn + b.signal_dn;
    const double d = a.signal_dn - b.signal_dn;
    all.sum += s;
    all.squares += s * s;
    all.difference += d;
    all.difference_squares += d * d;
    all.cubes += d * d * d;
    all.fourths += d * d * d * d;
    all.rounding += (a.rounding_dn2 + b.rounding_dn2) / 2;
  }
  return all;
}

void require_frames(std::span<const FlatPair> dark, std::span<const FlatPair> illuminated) {
  if (dark.empty() || illuminated.empty()) refuse("no dark or no illuminated pairs");
  const std::size_t pixels = dark.front().first.size();
  for (const std::span<const FlatPair> pairs : {dark, illuminated})
    for (const FlatPair& pair : pairs)
      if (pixels < 2 || pair.first.size() != pixels || pair.second.size() != pixels)
        refuse("the frames have unequal sizes");
}

PairMoments moments(const FlatPair& pair, const std::vector<CodeLevel>& levels) {
  const auto n = static_cast<double>(pair.first.size());
  const PairSums all = pair_sums(pair, levels);
  const double both = (all.difference_squares - all.difference * all.difference / n) / (n - 1) / 2;
  const double of_means = (all.squares - all.sum * all.sum / n) / (n - 1) / 4;
  const double m = all.difference / n;
  const double fourth =
      (all.fourths - 4 * m * all.cubes + 6 * m * m * all.difference_squares) / n - 3 * m * m * m * m;
  // The variance of a variance is (mu_4 - sigma^4)/n. The variance of the difference is twice the temporal
  // variance.
  const double error2 = std::max(0.0, fourth / 4 - both * both) / n;
  const double rounding = all.rounding / n;
  const double temporal = both - rounding;
  const double spatial = of_means - both / 2;
  const double uneven = rounding_error(12 * rounding, temporal, spatial);
  return {pair.exposure_s, all.sum / n / 2, temporal, spatial, error2 + uneven * uneven};
}

std::vector<PairMoments> all_moments(std::span<const FlatPair> pairs, const std::vector<CodeLevel>& levels) {
  std::vector<PairMoments> all;
  for (const FlatPair& pair : pairs) all.push_back(moments(pair, levels));
  return all;
}

// Least-squares line of a moment over the exposure time.
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
  if (!(spread > 0)) refuse("the dark pairs have only one exposure time: the dark current requires two");
  const double slope = (n * xy - x * y) / spread;
  return {(y - slope * x) / n, slope};
}

// Weights of the points in the value of their line at x.
std::vector<double> line_weights(const std::vector<PairMoments>& points, double x) {
  const auto n = static_cast<double>(points.size());
  double mean_time = 0;
  for (const PairMoments& p : points) mean_time += p.exposure_s / n;
  double spread = 0;
  for (const PairMoments& p : points) spread += (p.exposure_s - mean_time) * (p.exposure_s - mean_time);
  std::vector<double> weights;
  for (const PairMoments& p : points)
    weights.push_back(1 / n + (x - mean_time) * (p.exposure_s - mean_time) / spread);
  return weights;
}

// K = sum(s^2) / sum(s v). The variance of a pair changes ln K by -s / sum(s v), that of a dark pair through
// the line.
struct RelativeErrors {
  double gain;
  std::optional<double> read_noise;
};
RelativeErrors relative_errors(const std::vector<PairMoments>& dark,
                               const std::vector<PairMoments>& fitted_pairs, const Line& dark_mean,
                               double products, double read_variance) {
  std::vector<double> moved(dark.size(), 0);
  double illuminated_part = 0;
  for (const PairMoments& m : fitted_pairs) {
    const double by = (m.mean - dark_mean.at(m.exposure_s)) / products;
    illuminated_part += by * by * m.temporal_error2;
    const std::vector<double> weights = line_weights(dark, m.exposure_s);
    for (std::size_t j = 0; j < dark.size(); ++j) moved[j] += by * weights[j];
  }
  const std::vector<double> at_zero = line_weights(dark, 0);
  double gain = illuminated_part;
  double noise = illuminated_part;
  for (std::size_t j = 0; j < dark.size(); ++j) {
    gain += moved[j] * moved[j] * dark[j].temporal_error2;
    const double both = moved[j] + at_zero[j] / 2 / read_variance;
    noise += both * both * dark[j].temporal_error2;
  }
  return {std::sqrt(gain), read_variance > 0 ? std::optional(std::sqrt(noise)) : std::nullopt};
}

// A dark pair, and the weight of its frames in a sum.
struct WeightedPair {
  const FlatPair* pair;
  const PairMoments* moments;
  double weight;
};

// Largest dark signal of a pixel that counts: `room_dn` above the mean, plus what noise rarely exceeds.
double max_darkness(const std::vector<WeightedPair>& darkness, double room_dn) {
  constexpr double kDeviations = 4;
  double mean = 0;
  double noise = 0;  // of the mean of both frames' sums
  for (const auto& [pair, moments, weight] : darkness) {
    mean += weight * moments->mean;
    noise += weight * weight * std::max(0.0, moments->temporal) / 2;
  }
  return mean + room_dn + kDeviations * std::sqrt(noise);
}

// Spatial variance [DN^2] of darkness, or of an illuminated pair minus darkness. It is the covariance over
// the pixels of the sum of the first frames and that of the second ones, whose noise is independent. Noise
// can make it negative. Pixels count if their dark signal is at most `room_dn` above its mean, so that bright
// pixels of the illuminated pair are not excluded.
double pattern_variance(const std::vector<WeightedPair>& darkness, const FlatPair* illuminated,
                        double room_dn, const std::vector<CodeLevel>& levels) {
  const double max_dn = max_darkness(darkness, room_dn);
  double n = 0;
  double first = 0;
  double second = 0;
  double products = 0;
  for (std::size_t i = 0; i < darkness.front().pair->first.size(); ++i) {
    double a = 0;
    double b = 0;
    for (const auto& [pair, moments, weight] : darkness) {
      a += weight * levels[pair->first[i]].signal_dn;
      b += weight * levels[pair->second[i]].signal_dn;
    }
    if ((a + b) / 2 > max_dn) continue;
    if (illuminated != nullptr) {
      a -= levels[illuminated->first[i]].signal_dn;
      b -= levels[illuminated->second[i]].signal_dn;
    }
    n += 1;
    first += a;
    second += b;
    products += a * b;
  }
  return n > 1 ? (products - first * second / n) / (n - 1) : 0;
}

// Spatial variance [DN^2] of darkness at an exposure time, or of an illuminated pair minus that darkness,
// pixel by pixel. The dark signal of each pixel is proportional to time, hence the line through all dark
// pairs.
double pattern(std::span<const FlatPair> pairs, const std::vector<PairMoments>& dark,
               const std::vector<CodeLevel>& levels, double exposure_s, const FlatPair* illuminated = nullptr,
               double room_dn = std::numeric_limits<double>::infinity()) {
  const auto variance = [&](const std::vector<WeightedPair>& darkness) {
    return pattern_variance(darkness, illuminated, room_dn, levels);
  };
  std::vector<WeightedPair> equal;
  for (std::size_t j = 0; j < pairs.size(); ++j)
    if (pairs[j].exposure_s == exposure_s) equal.push_back({&pairs[j], &dark[j], 1});
  for (WeightedPair& term : equal) term.weight /= static_cast<double>(equal.size());
  if (!equal.empty()) return variance(equal);

  const std::vector<double> weights = line_weights(dark, exposure_s);
  std::vector<WeightedPair> line;
  double noise = 0;  // of a frame's sum; with the root of all pixels, that of the covariance of two
  for (std::size_t j = 0; j < pairs.size(); ++j) {
    line.push_back({&pairs[j], &dark[j], weights[j]});
    noise += weights[j] * weights[j] * dark[j].temporal;
  }
  noise /= std::sqrt(static_cast<double>(pairs.front().first.size()));
  const auto distance = [&](const WeightedPair& p) { return std::abs(p.pair->exposure_s - exposure_s); };
  const WeightedPair& nearest = *std::ranges::min_element(line, {}, distance);
  const double by_nearest = variance({{nearest.pair, nearest.moments, 1}});
  return noise > kPatternNoise * by_nearest ? by_nearest : variance(line);
}

std::vector<TransferPoint> points_of(const std::vector<PairMoments>& pairs, const Line& dark_mean,
                                     const Line& dark_variance) {
  std::vector<TransferPoint> points;
  for (const PairMoments& m : pairs)
    points.push_back({m.exposure_s, m.mean - dark_mean.at(m.exposure_s),
                      m.temporal - dark_variance.at(m.exposure_s), m.temporal_error2});
  return points;
}

// Result for pairs without unexpectedly full pixels.
struct Analysis {
  PhotonTransfer transfer;
  double full_dn;  // lowest signal of full pixels
};

Analysis analyse(std::span<const FlatPair> dark_pairs, std::span<const FlatPair> illuminated_pairs, int bits,
                 const std::vector<CodeLevel>& levels, double white_dn) {
  const std::vector<PairMoments> dark = all_moments(dark_pairs, levels);
  const std::vector<PairMoments> illuminated = all_moments(illuminated_pairs, levels);
  const Line dark_mean = fitted(dark, &PairMoments::mean);
  const Line dark_variance = fitted(dark, &PairMoments::temporal);
  const auto signal = [&](const PairMoments& m) { return m.mean - dark_mean.at(m.exposure_s); };

  // The variance is largest at saturation.
  const double saturation = signal(*std::ranges::max_element(illuminated, {}, &PairMoments::temporal));
  std::vector<PairMoments> below;
  std::ranges::copy_if(illuminated, std::back_inserter(below),
                       [&](const PairMoments& m) { return signal(m) <= kFitted * saturation; });
  const std::vector<TransferPoint> fitted_points = points_of(below, dark_mean, dark_variance);
  double products = 0;
  double squares = 0;
  for (const TransferPoint& p : fitted_points) {
    products += p.signal_dn * p.variance_dn2;
    squares += p.signal_dn * p.signal_dn;
  }
  if (below.empty()) refuse_bright_pairs(saturation, illuminated.size());
  if (!(products > 0)) refuse(kNoLight);
  const double gain = squares / products;
  const double read_variance = dark_variance.at_zero;
  const RelativeErrors errors = relative_errors(dark, below, dark_mean, products, read_variance);
  if (errors.gain > kMaxGainError) refuse(kNoLight);

  const PairMoments& brightest = *std::ranges::max_element(illuminated, {}, signal);
  const auto root = [](double x) { return std::sqrt(std::max(0.0, x)); };
  const std::size_t highest_code = (1U << static_cast<unsigned>(bits)) - 1;
  // All full wells hold the same number of electrons, so their variance is far below that of the light.
  const bool full =
      brightest.temporal - dark_variance.at(brightest.exposure_s) < signal(brightest) / gain / 2;
  const auto saturation_e = full ? std::optional((brightest.mean - dark_mean.at_zero) * gain) : std::nullopt;
  const auto full_well_e =
      brightest.mean < static_cast<double>(highest_code) - 1 ? saturation_e : std::nullopt;

  const double full_dn = full ? dark_mean.at_zero + kFull * (brightest.mean - dark_mean.at_zero) : white_dn;
  const auto from_half = [&](const PairMoments& m) { return std::abs(signal(m) - kPatternsAt * saturation); };
  const auto half_pair = std::ranges::min_element(illuminated, {}, from_half);
  const FlatPair& half = illuminated_pairs[static_cast<std::size_t>(half_pair - illuminated.begin())];
  // Dark signal above the mean that a pixel may have and still hold the light of that pair. A white level
  // below the pair does not limit it.
  const double above_half = (full ? brightest.mean : white_dn) - half_pair->mean;
  const double room_dn = above_half > 0 ? above_half : std::numeric_limits<double>::infinity();
  const double read_noise = root(read_variance) * gain;
  Analysis all{
      {gain, read_noise, dark_mean.slope * gain,
       100 * root(pattern(dark_pairs, dark, levels, half.exposure_s, &half, room_dn)) / signal(*half_pair),
       root(pattern(dark_pairs, dark, levels, 0)) * gain, full_well_e,
       points_of(illuminated, dark_mean, dark_variance), errors.gain * gain,
       errors.read_noise ? std::optional(*errors.read_noise * read_noise) : std::nullopt, saturation_e},
      full_dn};
  PhotonTransfer& transfer = all.transfer;
  transfer.linearity_error_percent = linearity_error_percent(transfer.points, saturation);
  transfer.gain_bias = gain_bias(fitted_points, transfer.linearity_error_percent.has_value());
  return all;
}

// True for each pixel that is full in one of these pairs.
std::vector<bool> full_pixels(std::span<const FlatPair> pairs, const std::vector<CodeLevel>& levels,
                              double full_dn) {
  std::vector<bool> full(pairs.front().first.size(), false);
  for (const FlatPair& pair : pairs)
    for (std::size_t i = 0; i < full.size(); ++i)
      if (std::min(levels[pair.first[i]].signal_dn, levels[pair.second[i]].signal_dn) >= full_dn)
        full[i] = true;
  return full;
}

// Pairs without the excluded pixels.
struct SelectedPairs {
  std::deque<std::vector<std::uint16_t>> codes;
  std::vector<FlatPair> pairs;

  SelectedPairs(std::span<const FlatPair> all, const std::vector<bool>& excluded) {
    const auto selected = [&](std::span<const std::uint16_t> frame) {
      std::vector<std::uint16_t>& some = codes.emplace_back();
      for (std::size_t i = 0; i < frame.size(); ++i)
        if (!excluded[i]) some.push_back(frame[i]);
      return std::span<const std::uint16_t>(some);
    };
    for (const FlatPair& pair : all)
      pairs.push_back({pair.exposure_s, selected(pair.first), selected(pair.second)});
  }
};
}  // namespace

std::optional<double> linearity_error_percent(std::span<const TransferPoint> points, double saturation_dn) {
  std::vector<TransferPoint> counted;
  std::vector<Sample> samples;
  for (const TransferPoint& p : points) {
    if (p.signal_dn < kLowest * saturation_dn || p.signal_dn > kHighest * saturation_dn) continue;
    counted.push_back(p);
    samples.push_back({p.exposure_s, p.signal_dn, 1 / (p.signal_dn * p.signal_dn)});
  }
  if (distinct(counted, &TransferPoint::exposure_s) < kMinTimes) return std::nullopt;
  const auto line = fitted_line(samples);
  if (!line) return std::nullopt;
  double sum = 0;
  for (const Sample& s : samples) sum += std::abs(s.y / (line->at_zero + line->slope * s.x) - 1);
  const double percent = 100 * sum / static_cast<double>(samples.size());
  return percent <= kSteadyLight ? std::optional(percent) : std::nullopt;
}

std::optional<RelativeBias> gain_bias(std::span<const TransferPoint> points, bool is_light_constant) {
  if (is_light_constant && distinct(points, &TransferPoint::exposure_s) >= kMinSignals)
    return bias_by_times(points);
  if (distinct(points, &TransferPoint::signal_dn) < kMinSignals) return std::nullopt;
  return bias_by_variances(points);
}

PhotonTransfer photon_transfer(std::span<const FlatPair> dark_pairs,
                               std::span<const FlatPair> illuminated_pairs, int bits,
                               const std::vector<CodeLevel>& levels, std::uint16_t white_dn) {
  require_frames(dark_pairs, illuminated_pairs);
  const double white =
      levels[std::min<std::size_t>(white_dn, (1U << static_cast<unsigned>(bits)) - 1)].signal_dn;
  Analysis analysis = analyse(dark_pairs, illuminated_pairs, bits, levels, white);
  // Full hot pixels show neither the growth nor the noise of their dark signal.
  const std::vector<bool> full = full_pixels(dark_pairs, levels, analysis.full_dn);
  const auto full_ones = static_cast<std::size_t>(std::count(full.begin(), full.end(), true));
  if (full_ones == 0) return std::move(analysis.transfer);
  if (full_ones + 2 > full.size()) refuse("all pixels of a dark pair are full: shorter exposures are needed");
  const SelectedPairs dark(dark_pairs, full);
  const SelectedPairs illuminated(illuminated_pairs, full);
  return analyse(dark.pairs, illuminated.pairs, bits, levels, white).transfer;
}

}  // namespace abbe

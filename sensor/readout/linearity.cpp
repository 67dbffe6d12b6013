#include "sensor/readout/linearity.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

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

std::size_t distinct(std::span<const LinearityPoint> points, double LinearityPoint::*value) {
  std::set<double> unique_values;
  for (const LinearityPoint& p : points) unique_values.insert(p.*value);
  return unique_values.size();
}

// Relative curvature b of y/t = c (1 + b t) over the exposure time, and its standard error from the residuals
// of the parabola.
std::optional<RelativeBias> curvature_over_time(std::span<const LinearityPoint> points) {
  std::vector<Sample> samples;
  for (const LinearityPoint& p : points) samples.push_back({p.exposure_s, p.signal_dn / p.exposure_s, 1});
  const auto line = fitted_line(samples);
  if (!line || !(line->at_zero > 0)) return std::nullopt;
  double squares = 0;
  for (const Sample& s : samples) squares += std::pow(s.y - line->at_zero - line->slope * s.x, 2);
  const double spread = std::sqrt(squares / std::max(1.0, static_cast<double>(points.size()) - 2));
  return RelativeBias{line->slope / line->at_zero, spread * std::sqrt(line->slope_variance) / line->at_zero};
}

// Relative bias of the gain for a curvature b over the exposure time.
double bias_of(std::span<const LinearityPoint> points, double curvature) {
  double squares = 0;
  double products = 0;
  for (const LinearityPoint& p : points) {
    const double light = p.exposure_s;
    const double signal = light * (1 + curvature * light);
    const double slope = 1 + 2 * curvature * light;
    squares += signal * signal;
    products += signal * slope * slope * light;
  }
  return squares / products - 1;
}

std::optional<RelativeBias> bias_by_times(std::span<const LinearityPoint> points) {
  const auto curvature = curvature_over_time(points);
  if (!curvature) return std::nullopt;
  const double bias = bias_of(points, curvature->value);
  const double moved = bias_of(points, curvature->value + curvature->standard_error);
  return RelativeBias{bias, std::abs(moved - bias)};
}

std::optional<RelativeBias> bias_by_variances(std::span<const LinearityPoint> points) {
  std::vector<Sample> samples;
  double squares = 0;
  double products = 0;
  for (const LinearityPoint& p : points) {
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

}  // namespace

std::optional<double> linearity_error_percent(std::span<const LinearityPoint> points, double saturation_dn) {
  std::vector<LinearityPoint> counted;
  std::vector<Sample> samples;
  for (const LinearityPoint& p : points) {
    if (p.signal_dn < kLowest * saturation_dn || p.signal_dn > kHighest * saturation_dn) continue;
    counted.push_back(p);
    samples.push_back({p.exposure_s, p.signal_dn, 1 / (p.signal_dn * p.signal_dn)});
  }
  if (distinct(counted, &LinearityPoint::exposure_s) < kMinTimes) return std::nullopt;
  const auto line = fitted_line(samples);
  if (!line) return std::nullopt;
  double sum = 0;
  for (const Sample& s : samples) sum += std::abs(s.y / (line->at_zero + line->slope * s.x) - 1);
  const double percent = 100 * sum / static_cast<double>(samples.size());
  return percent <= kSteadyLight ? std::optional(percent) : std::nullopt;
}

std::optional<RelativeBias> gain_bias(std::span<const LinearityPoint> points, bool is_light_constant) {
  if (is_light_constant && distinct(points, &LinearityPoint::exposure_s) >= kMinSignals)
    return bias_by_times(points);
  if (distinct(points, &LinearityPoint::signal_dn) < kMinSignals) return std::nullopt;
  return bias_by_variances(points);
}

}  // namespace abbe

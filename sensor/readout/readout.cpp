#include "sensor/readout/readout.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/poisson_distribution.hpp>

#include "io/error.h"
#include "sensor/readout/random.h"

namespace abbe {
namespace {

using Normal = boost::random::normal_distribution<double>;

// Beyond this a Poisson distribution is too narrow for 64-bit integers to matter, and no well is so deep.
constexpr double kMostElectrons = 1e15;

double poisson(double mean, SplitMix64& random) {
  if (!(mean > 0)) return 0;
  return static_cast<double>(boost::random::poisson_distribution<std::int64_t, double>(mean)(random));
}

// What is odd about a pixel in every exposure.
struct FixedPattern {
  double sensitivity;
  double offset_e;
};
FixedPattern fixed_pattern(const Readout& readout, std::size_t pixel) {
  if (readout.prnu_percent == 0 && readout.dsnu_e == 0) return {1, 0};
  SplitMix64 random(ReadoutPurpose::fixed_pattern, readout.serial, pixel);
  const double sensitivity = 1 + readout.prnu_percent / 100 * Normal()(random);
  return {std::max(0.0, sensitivity), readout.dsnu_e * Normal()(random)};
}

// Code of a signal in units of codes, before it is rounded.
double curved(const Readout& readout, double signal) {
  const double codes = readout.highest_code() - readout.offset_dn;
  return readout.offset_dn +
         (readout.response_curve ? codes * (*readout.response_curve)(signal / codes) : signal);
}

template <double MonotoneCurve::Point::*From, double MonotoneCurve::Point::*To>
double interpolated(const std::vector<MonotoneCurve::Point>& points, double x) {
  const auto after = std::find_if(points.begin() + 1, points.end() - 1,
                                  [x](const MonotoneCurve::Point& p) { return x < p.*From; });
  const MonotoneCurve::Point& b = *after;
  const MonotoneCurve::Point& a = *(after - 1);
  return a.*To + (x - a.*From) / (b.*From - a.*From) * (b.*To - a.*To);
}

}  // namespace

MonotoneCurve::MonotoneCurve(std::vector<Point> points) : points_(std::move(points)) {
  const auto falls = [](const Point& a, const Point& b) { return !(a.in < b.in && a.out < b.out); };
  if (points_.size() < 2 || std::adjacent_find(points_.begin(), points_.end(), falls) != points_.end())
    throw Error(ErrorCode::internal, "response curve", "does not increase");
}

double MonotoneCurve::operator()(double in) const {
  return interpolated<&Point::in, &Point::out>(points_, in);
}

double MonotoneCurve::inverse(double out) const {
  return interpolated<&Point::out, &Point::in>(points_, out);
}

double gathering_area(double pixel_pitch_m, double fill_factor) {
  return pixel_pitch_m * pixel_pitch_m * fill_factor;
}

RawFrame read_out(const Readout& readout, std::span<const float> expected_e, const Exposure& exposure) {
  RawFrame frame;
  frame.dn.reserve(expected_e.size());
  frame.saturated.reserve(expected_e.size());
  const SplitMix64 frames(ReadoutPurpose::noise, exposure.seed, exposure.frame);
  const std::uint64_t key = SplitMix64(frames)();
  for (std::size_t pixel = 0; pixel < expected_e.size(); ++pixel) {
    const double light_e = std::max(0.0, static_cast<double>(expected_e[pixel]));
    if (!(light_e <= kMostElectrons) || std::isnan(expected_e[pixel]))
      throw Error(ErrorCode::input, "film",
                  "pixel " + std::to_string(pixel) + " expects " + std::to_string(expected_e[pixel]) +
                      " electrons (allowed up to 1e15)");
    const FixedPattern pattern = fixed_pattern(readout, pixel);
    SplitMix64 random(ReadoutPurpose::noise, key, pixel);
    const double freed_e =
        poisson(light_e * pattern.sensitivity + readout.dark_e_per_s * exposure.seconds, random);
    const double held_e = std::min(freed_e, readout.full_well_e);
    const double signal_e = held_e + pattern.offset_e + readout.read_noise_e * Normal()(random);
    const double code = std::floor(curved(readout, signal_e / readout.gain_e_per_dn) + 0.5);
    frame.dn.push_back(static_cast<std::uint16_t>(std::clamp(code, 0.0, readout.highest_code())));
    frame.saturated.push_back(freed_e >= readout.full_well_e || code >= readout.highest_code());
  }
  return frame;
}

double electrons_of(const Readout& readout, double dn) {
  const double codes = readout.highest_code() - readout.offset_dn;
  const double signal = dn - readout.offset_dn;
  return readout.gain_e_per_dn *
         (readout.response_curve ? codes * readout.response_curve->inverse(signal / codes) : signal);
}

TemporalNoise temporal_noise(const Readout& readout, double mean_e, double exposure_s) {
  TemporalNoise noise{std::sqrt(std::max(0.0, mean_e)), std::sqrt(readout.dark_e_per_s * exposure_s),
                      readout.read_noise_e, readout.gain_e_per_dn / std::sqrt(12.0), 0};
  noise.total_e =
      std::hypot(std::hypot(noise.photon_e, noise.dark_e), std::hypot(noise.read_e, noise.quantisation_e));
  return noise;
}

}  // namespace abbe

#include "sensor/readout/readout.h"

#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/poisson_distribution.hpp>
#include <boost/random/uniform_01.hpp>

#include "io/error.h"
#include "sensor/random.h"

namespace abbe {

namespace {

using Normal = boost::random::normal_distribution<double>;
using Uniform = boost::random::uniform_01<double>;

// No well is so deep. Above this number, a Poisson distribution is too narrow for the range of 64-bit
// integers.
constexpr double kMaxElectrons = 1e15;
constexpr double kSaturationDeviations = 6;

double poisson(double mean, SplitMix64& random) {
  if (!(mean > 0)) return 0;
  return static_cast<double>(boost::random::poisson_distribution<std::int64_t, double>(mean)(random));
}

// Checks the expected electrons of a pixel. Throws Error{input} if they are not a number or too many.
double countable(double electrons, const char* of_what, std::size_t pixel) {
  if (!(electrons <= kMaxElectrons))
    throw Error(
        ErrorCode::input, "film",
        fmt::format("pixel {} expects {:g} electrons{} (allowed up to 1e15)", pixel, electrons, of_what));
  return electrons;
}

// Deviations of a pixel that are the same in every exposure.
struct FixedPattern {
  double sensitivity = 1;
  double offset_e = 0;
  double hot_e_per_s = 0;
};
FixedPattern fixed_pattern(const Readout& readout, std::size_t pixel) {
  if (readout.prnu_percent == 0 && readout.dsnu_e == 0 && readout.hot_pixels_percent == 0) return {};
  SplitMix64 random(ReadoutPurpose::fixed_pattern, readout.serial, pixel);
  const double sensitivity = 1 + readout.prnu_percent / 100 * Normal()(random);
  FixedPattern pattern{std::max(0.0, sensitivity), readout.dsnu_e * Normal()(random)};
  if (readout.hot_pixels_percent > 0 && 100 * Uniform()(random) < readout.hot_pixels_percent)
    pattern.hot_e_per_s = -readout.hot_pixel_e_per_s * std::log1p(-Uniform()(random));
  return pattern;
}

// State of a pixel between the generation of its electrons and their conversion.
struct ExposedPixel {
  double generated_e;
  double stored_e;
  double offset_e;
  SplitMix64 random;  // continues with the read noise
};

ExposedPixel expose_pixel(const Readout& readout, float expected_e, std::size_t pixel, double seconds,
                          std::uint64_t key) {
  const double light_e = std::max(0.0, countable(static_cast<double>(expected_e), "", pixel));
  const FixedPattern pattern = fixed_pattern(readout, pixel);
  SplitMix64 random(ReadoutPurpose::noise, key, pixel);
  const double dark_e = (readout.dark_e_per_s + pattern.hot_e_per_s) * seconds;
  const double mean_e = countable(light_e * pattern.sensitivity + dark_e, " with its dark signal", pixel);
  const double generated_e = poisson(mean_e, random);
  return {generated_e, std::min(generated_e, readout.full_well_e), pattern.offset_e, random};
}

// Moves half of the excess charge of each pixel along its column, in steps of `step` pixels.
void overflow(std::vector<ExposedPixel>& pixels, std::size_t first, std::ptrdiff_t step, std::size_t rows,
              double full_well_e) {
  double flowing_e = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    ExposedPixel& pixel = pixels[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(first) +
                                                          static_cast<std::ptrdiff_t>(row) * step)];
    const double taken_e = std::min(flowing_e, full_well_e - pixel.stored_e);
    pixel.stored_e += taken_e;
    flowing_e += std::max(0.0, pixel.generated_e - full_well_e) / 2 - taken_e;
  }
}

void bloom(std::vector<ExposedPixel>& pixels, std::size_t width, double full_well_e) {
  const std::size_t rows = pixels.size() / width;
  const auto step = static_cast<std::ptrdiff_t>(width);
  for (std::size_t column = 0; column < width; ++column) {
    overflow(pixels, column, step, rows, full_well_e);
    overflow(pixels, (rows - 1) * width + column, -step, rows, full_well_e);
  }
}

// Code of a signal in DN, before rounding.
double curved(const Readout& readout, double signal) {
  const double codes = readout.highest_code() - readout.offset_dn;
  return readout.offset_dn +
         (readout.response_curve ? codes * (*readout.response_curve)(signal / codes) : signal);
}

// Code of a sensor without the response curve, before rounding.
double linear_code(const Readout& readout, double dn) {
  return readout.offset_dn + electrons_of(readout, dn) / readout.gain_e_per_dn;
}

// Code of a number of electrons, before clipping to the range of codes.
double code_of(const Readout& readout, double electrons) {
  return std::floor(curved(readout, electrons / readout.gain_e_per_dn) + 0.5);
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
  const SplitMix64 frames(ReadoutPurpose::noise, exposure.seed, exposure.frame);
  const std::uint64_t key = SplitMix64(frames)();
  const std::size_t width = exposure.width > 0 ? exposure.width : std::max<std::size_t>(1, expected_e.size());
  std::vector<ExposedPixel> pixels;
  pixels.reserve(expected_e.size());
  for (const float e : expected_e)
    pixels.push_back(expose_pixel(readout, e, pixels.size(), exposure.seconds_of(pixels.size()), key));
  if (readout.blooming && !pixels.empty()) bloom(pixels, width, readout.full_well_e);

  RawFrame frame;
  frame.dn.reserve(pixels.size());
  frame.saturated.reserve(pixels.size());
  double row_e = 0;
  for (ExposedPixel& pixel : pixels) {
    if (readout.row_noise_e > 0 && frame.dn.size() % width == 0) {
      SplitMix64 random(ReadoutPurpose::row_noise, key, frame.dn.size() / width);
      row_e = readout.row_noise_e * Normal()(random);
    }
    const double signal_e =
        pixel.stored_e + pixel.offset_e + row_e + readout.read_noise_e * Normal()(pixel.random);
    const double code = code_of(readout, signal_e);
    frame.dn.push_back(static_cast<std::uint16_t>(std::clamp(code, 0.0, readout.highest_code())));
    frame.saturated.push_back(pixel.stored_e >= readout.full_well_e || code >= readout.highest_code());
  }
  return frame;
}

double electrons_of(const Readout& readout, double dn) {
  const double codes = readout.highest_code() - readout.offset_dn;
  const double signal = dn - readout.offset_dn;
  return readout.gain_e_per_dn *
         (readout.response_curve ? codes * readout.response_curve->inverse(signal / codes) : signal);
}

double black_level(const Readout& readout, double exposure_s) {
  const double dark_dn = readout.offset_dn + readout.dark_e_per_s * exposure_s / readout.gain_e_per_dn;
  return dark_dn < linear_code(readout, white_level(readout)) ? dark_dn : readout.offset_dn;
}

std::vector<std::uint16_t> linear_codes(const Readout& readout) {
  std::vector<std::uint16_t> table;
  if (!readout.response_curve) return table;
  for (double dn = 0; dn <= readout.highest_code(); ++dn)
    table.push_back(static_cast<std::uint16_t>(
        std::clamp(std::round(linear_code(readout, dn)), 0.0, readout.highest_code())));
  return table;
}

double white_level(const Readout& readout) {
  const double added_e = std::hypot(readout.read_noise_e, readout.row_noise_e, readout.dsnu_e);
  const double full_e =
      std::max(readout.full_well_e - kSaturationDeviations * added_e, readout.full_well_e / 2);
  return std::min(code_of(readout, full_e), readout.highest_code());
}

TemporalNoise temporal_noise(const Readout& readout, double mean_e, double exposure_s) {
  TemporalNoise noise{std::sqrt(std::max(0.0, mean_e)),
                      std::sqrt(readout.dark_e_per_s * exposure_s),
                      readout.read_noise_e,
                      readout.row_noise_e,
                      readout.gain_e_per_dn / std::sqrt(12.0),
                      0};
  noise.total_e = std::hypot(std::hypot(noise.photon_e, noise.dark_e), std::hypot(noise.read_e, noise.row_e),
                             noise.quantisation_e);
  return noise;
}

// Widths may differ from code to code. If the noise is wider than they are, a signal y of the converter gives
// the code y + q, with q uniform on [-1/2, 1/2] and independent of y.
std::vector<CodeLevel> code_levels(const Readout& readout) {
  constexpr std::size_t kCodes = 1U << 16U;
  std::vector<CodeLevel> levels;
  for (std::size_t code = 0; code < kCodes; ++code) levels.push_back({static_cast<double>(code), 1.0 / 12});
  const auto signal = [&](double dn) { return linear_code(readout, dn); };
  const std::vector<std::uint16_t> straight = linear_codes(readout);
  auto next = straight.begin();
  while (next != straight.end()) {
    auto first = next;
    next = std::upper_bound(first, straight.end(), *first);
    const auto code = [&](auto at) { return static_cast<double>(at - straight.begin()); };
    // Signals below the lowest code are clipped.
    while (first + 1 != next && signal(code(first)) < -0.5) ++first;
    const double low = signal(code(first) - 0.5);
    const double width = signal(code(next) - 0.5) - low;
    levels[*first] = {low + width / 2, width * width / 12};
  }
  return levels;
}

}  // namespace abbe

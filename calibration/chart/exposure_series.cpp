#include "calibration/chart/exposure_series.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "io/error.h"
#include "io/text.h"

namespace abbe {

PlantedResponse::PlantedResponse(const std::string& description) {
  constexpr std::string_view kGamma = "gamma:";
  if (description == "linear") return;
  if (description == "s-curve") {
    power_ = 1.4;
    shoulder_ = std::pow(0.18, power_);
    return;
  }
  const std::optional<double> gamma =
      description.starts_with(kGamma) ? parse_number(description.substr(kGamma.size())) : std::nullopt;
  if (!gamma || !(*gamma >= 0.2 && *gamma <= 5))
    throw Error(ErrorCode::usage, "--response",
                fmt::format("expected linear, s-curve or gamma:G with G in [0.2, 5] (got {})", description));
  power_ = 1 / *gamma;
}

// z = x^p (1 + s)/(x^p + s) with s = 0 for a pure power.
double PlantedResponse::code(double exposure) const {
  const double p = std::pow(std::clamp(exposure, 0.0, 1.0), power_);
  return shoulder_ > 0 ? p * (1 + shoulder_) / (p + shoulder_) : p;
}

double PlantedResponse::exposure(double code) const {
  const double z = std::clamp(code, 0.0, 1.0);
  const double p = shoulder_ > 0 ? shoulder_ * z / (1 + shoulder_ - z) : z;
  return std::pow(p, 1 / power_);
}

double CodeNoise::deviation(double code) const {
  const double step = bits > 0 ? 1 / (std::ldexp(1.0, bits) - 1) : 0;
  return std::sqrt(read * read + shot * std::max(0.0, code) + step * step / 12);
}

ExposureSeries expose(std::span<const double> values, std::span<const double> times_s,
                      const PlantedResponse& response, const CodeNoise& noise, std::uint64_t seed) {
  const double full_scale = std::ldexp(1.0, noise.bits) - 1;
  const CodeNoise before_rounding{0, noise.read, noise.shot};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ExposureSeries series{{times_s.begin(), times_s.end()}, {}, {}};
  const bool is_noisy = noise.deviation(1) > 0;
  for (const double value : values) {
    std::vector<double>& codes = series.codes.emplace_back();
    if (is_noisy) series.deviations.emplace_back();
    for (const double time : times_s) {
      const double mean = response.code(value * time);
      double code = std::clamp(mean + before_rounding.deviation(mean) * normal(random), 0.0, 1.0);
      if (noise.bits > 0) code = std::round(code * full_scale) / full_scale;
      codes.push_back(code);
      if (is_noisy) series.deviations.back().push_back(noise.deviation(code));
    }
  }
  return series;
}

}  // namespace abbe

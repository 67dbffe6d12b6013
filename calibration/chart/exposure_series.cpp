#include "calibration/chart/exposure_series.h"

#include <algorithm>
#include <cmath>

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
    throw Error(ErrorCode::usage, "response",
                fmt::format("expected linear, s-curve or gamma:G with G in [0.2, 5] (got {})", description));
  power_ = 1 / *gamma;
}

double PlantedResponse::code(double exposure) const {
  const double p = std::pow(std::clamp(exposure, 0.0, 1.0), power_);
  return shoulder_ > 0 ? p * (1 + shoulder_) / (p + shoulder_) : p;
}

double PlantedResponse::exposure(double code) const {
  const double z = std::clamp(code, 0.0, 1.0);
  const double p = shoulder_ > 0 ? shoulder_ * z / (1 + shoulder_ - z) : z;
  return std::pow(p, 1 / power_);
}

ExposureSeries expose(std::span<const double> values, std::span<const double> times_s,
                      const PlantedResponse& response, int bits) {
  const double full_scale = std::ldexp(1.0, bits) - 1;
  ExposureSeries series{{times_s.begin(), times_s.end()}, {}};
  for (const double value : values) {
    std::vector<double>& codes = series.codes.emplace_back();
    for (const double time : times_s) {
      const double code = response.code(value * time);
      codes.push_back(bits > 0 ? std::round(code * full_scale) / full_scale : code);
    }
  }
  return series;
}

}  // namespace abbe

#include "calibration/chart/patches.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {
namespace {

void require_visible(const Channel& channel, double diffuser) {
  if (std::isfinite(diffuser) && diffuser > 0) return;
  throw Error(
      ErrorCode::input, "channel " + channel.name,
      fmt::format("it receives nothing from the light (sum {}), so colours cannot be calibrated", diffuser));
}

// Channel whose diffuser value is the unit of raw values.
const Channel& reference_channel(std::span<const Channel> channels) {
  for (const char* name : {"G", "Y"})
    if (const auto found = std::ranges::find(channels, name, &Channel::name); found != channels.end())
      return *found;
  return channels.front();
}

}  // namespace

SumRange sensed(std::span<const Channel> channels) {
  return standard_observer(channels) ? SumRange{} : SumRange{kMinWavelengthNm, kMaxWavelengthNm};
}

XYZ unit_tristimulus(const Curve& illuminant, const Curve& reflectance, SumRange range) {
  XYZ xyz = tristimulus(illuminant, reflectance, Observer::cie1931, range);
  for (double& v : xyz) v /= 100;
  return xyz;
}

std::vector<double> camera_raw(std::span<const Channel> channels, const Curve& illuminant,
                               const Curve& reflectance) {
  if (channels.empty()) return {};
  const Channel& reference = reference_channel(channels);
  const double unit = sum_product(illuminant, reference.weight, sensed(channels));
  require_visible(reference, unit);
  std::vector<double> raw;
  for (const Channel& channel : channels)
    raw.push_back(sum_product(illuminant, channel.weight, reflectance, sensed(channels)) / unit);
  return raw;
}

std::vector<double> diffuser_values(std::span<const Channel> channels, const Curve& illuminant) {
  std::vector<double> values;
  for (const Channel& channel : channels) {
    values.push_back(sum_product(illuminant, channel.weight, sensed(channels)));
    require_visible(channel, values.back());
  }
  return values;
}

PatchColors integrate(const Chart& chart, std::span<const Channel> channels, const Curve& illuminant,
                      SumRange range) {
  if (channels.size() != 3)
    throw Error(ErrorCode::usage, "camera",
                fmt::format("calibration needs three channels (got {})", channels.size()));
  const std::vector<double> white = diffuser_values(channels, illuminant);
  PatchColors colors;
  colors.white = unit_tristimulus(illuminant, Curve(1.0), range);
  for (const Patch& patch : chart.patches) {
    Raw raw{};
    for (std::size_t k = 0; k < raw.size(); ++k)
      raw[k] = sum_product(illuminant, channels[k].weight, patch.reflectance, sensed(channels)) / white[k];
    colors.names.push_back(patch.name);
    colors.raw.push_back(raw);
    colors.xyz.push_back(unit_tristimulus(illuminant, patch.reflectance, range));
  }
  return colors;
}

}  // namespace abbe

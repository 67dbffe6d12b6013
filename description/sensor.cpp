#include "description/sensor.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/image.h"

namespace abbe::description {
namespace {

void build_resolution(const spec::Sensor& said, bool probe, Sensor& sensor, LoadContext& context) {
  if (!said.resolution) {
    if (!probe) context.diagnostics.error(said.where, "missing key \"resolution\"");
    return;
  }
  const auto [width, height] = said.resolution->value;
  if (std::max(width, height) > kMaxImageEdge || static_cast<std::size_t>(width * height) > kMaxImagePixels) {
    context.diagnostics.error(
        said.resolution->where,
        fmt::format("too many pixels (got {} x {}, allowed edges up to {} and {} pixels in all)", width,
                    height, kMaxImageEdge, kMaxImagePixels),
        ErrorCode::resource);
    return;
  }
  sensor.width = static_cast<int>(width);
  sensor.height = static_cast<int>(height);
}

// The channel of one place of a pattern.
std::optional<int> build_place(const schema::Located<std::string>& name,
                               const std::vector<std::string>& names, LoadContext& context) {
  const auto known = std::find(names.begin(), names.end(), name.value);
  if (known != names.end()) return static_cast<int>(known - names.begin());
  context.diagnostics.error(name.where, unknown_name("channel", name.value, names));
  return std::nullopt;
}

std::optional<Mosaic> build_mosaic(const spec::Sensor& said, const std::vector<Channel>& channels,
                                   LoadContext& context) {
  if (channels.empty()) return std::nullopt;  // what is wrong with the channels is told
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  const auto& rows = said.mosaic->value;
  Mosaic mosaic{static_cast<int>(rows.front().value.size()), static_cast<int>(rows.size()), {}};
  for (const auto& row : rows) {
    if (row.value.size() != static_cast<std::size_t>(mosaic.width)) {
      context.diagnostics.error(
          row.where, fmt::format("rows of a mosaic have one length (got {}, allowed {})", row.value.size(),
                                 mosaic.width));
      return std::nullopt;
    }
    for (const auto& place : row.value)
      if (const auto channel = build_place(place, names, context)) mosaic.channel.push_back(*channel);
  }
  if (mosaic.channel.size() != rows.size() * static_cast<std::size_t>(mosaic.width)) return std::nullopt;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::ranges::count(mosaic.channel, static_cast<int>(i)) == 0)
      context.diagnostics.error(said.mosaic->where, fmt::format("has no place for channel \"{}\"", names[i]));
  return mosaic;
}

// The electronics behind channels, which must count electrons.
std::optional<Readout> build_readout(const spec::Sensor& said, const std::vector<Channel>& channels,
                                     const LoadContext& context) {
  for (const Channel& channel : channels)
    if (channel.kind != ResponseKind::quantum)
      context.diagnostics.error(
          said.readout->where,
          fmt::format("a read-out needs channels that count electrons (got \"{}\", whose response is "
                      "energy, allowed quantum)",
                      channel.name));
  return abbe::build(said.readout->value, context.diagnostics);
}

}  // namespace

Sensor build(const spec::Sensor& said, bool probe, LoadContext& context) {
  Sensor sensor;
  build_resolution(said, probe, sensor, context);
  sensor.pixel_pitch = said.pixel_pitch_um * 1e-6;
  sensor.exposure_s = said.exposure_s;
  sensor.fill_factor = said.fill_factor;
  build_channels(said, sensor, context);
  if (said.mosaic && !sensor.spectral) sensor.mosaic = build_mosaic(said, sensor.channels, context);
  if (said.readout) sensor.readout = build_readout(said, sensor.channels, context);
  return sensor;
}

}  // namespace abbe::description

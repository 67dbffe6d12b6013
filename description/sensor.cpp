#include "description/sensor.h"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "description/values.h"
#include "io/image.h"
#include "sensor/readout/readout_json.h"

namespace abbe::description {
namespace {

constexpr Range kCount{1};
constexpr Range kPitch{0, 1e6, true, false};  // um
constexpr Range kFill{0, 1, true, false};

void read_resolution(ObjectReader& reader, bool probe, Sensor& sensor, LoadContext& context) {
  const JsonValue* json = probe ? reader.find("resolution") : reader.require("resolution");
  if (!json || !read_numbers(*json, 2, Range::any(), context.diagnostics)) return;
  const auto& edges = std::get<JsonValue::Array>(json->value);
  const auto width = read_integer(edges[0], kCount, context.diagnostics);
  const auto height = read_integer(edges[1], kCount, context.diagnostics);
  if (!width || !height) return;
  if (std::max(*width, *height) > kMaxImageEdge ||
      static_cast<std::size_t>(*width * *height) > kMaxImagePixels) {
    context.diagnostics.error(
        json->where,
        fmt::format("too many pixels (got {} x {}, allowed edges up to {} and {} pixels in all)", *width,
                    *height, kMaxImageEdge, kMaxImagePixels),
        ErrorCode::resource);
    return;
  }
  sensor.width = static_cast<int>(*width);
  sensor.height = static_cast<int>(*height);
}

// The channel of one place of a pattern.
std::optional<int> read_place(const JsonValue& json, const std::vector<std::string>& names,
                              LoadContext& context) {
  const auto name = read_string(json, context.diagnostics);
  if (!name) return std::nullopt;
  const auto known = std::find(names.begin(), names.end(), *name);
  if (known != names.end()) return static_cast<int>(known - names.begin());
  context.diagnostics.error(json.where, unknown_name("channel", *name, names));
  return std::nullopt;
}

std::optional<Mosaic> read_mosaic(const JsonValue& json, const std::vector<Channel>& channels,
                                  LoadContext& context) {
  const JsonValue::Array* rows = read_array(json, "rows", 1, context.diagnostics);
  if (!rows || channels.empty()) return std::nullopt;  // what is wrong with the channels is told
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  Mosaic mosaic{0, static_cast<int>(rows->size()), {}};
  for (const JsonValue& row : *rows) {
    const JsonValue::Array* places = read_array(row, "channels' names", 1, context.diagnostics);
    if (!places) return std::nullopt;
    if (mosaic.width == 0) mosaic.width = static_cast<int>(places->size());
    if (places->size() != static_cast<std::size_t>(mosaic.width)) {
      context.diagnostics.error(
          row.where,
          fmt::format("rows of a mosaic have one length (got {}, allowed {})", places->size(), mosaic.width));
      return std::nullopt;
    }
    for (const JsonValue& place : *places)
      if (const auto channel = read_place(place, names, context)) mosaic.channel.push_back(*channel);
  }
  if (mosaic.channel.size() != rows->size() * static_cast<std::size_t>(mosaic.width)) return std::nullopt;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::ranges::count(mosaic.channel, static_cast<int>(i)) == 0)
      context.diagnostics.error(json.where, fmt::format("has no place for channel \"{}\"", names[i]));
  return mosaic;
}

// The electronics behind channels, which must count electrons.
std::optional<Readout> read_readout(const JsonValue& json, std::span<const Channel> channels,
                                    const LoadContext& context) {
  for (const Channel& channel : channels)
    if (channel.kind != ResponseKind::quantum)
      context.diagnostics.error(
          json.where,
          fmt::format("a read-out needs channels that count electrons (got \"{}\", whose response is "
                      "energy, allowed quantum)",
                      channel.name));
  return abbe::read_readout(json, context.diagnostics);
}

}  // namespace

Sensor read_sensor(const JsonValue& json, bool probe, LoadContext& context) {
  Sensor sensor;
  ObjectReader reader(json, context.diagnostics);
  read_resolution(reader, probe, sensor, context);
  sensor.pixel_pitch = reader.number_or("pixel_pitch_um", sensor.pixel_pitch * 1e6, kPitch) * 1e-6;
  sensor.exposure_s = reader.number_or("exposure_s", sensor.exposure_s, kExposure);
  sensor.fill_factor = reader.number_or("fill_factor", sensor.fill_factor, kFill);
  read_channels(reader, sensor, context);
  if (const JsonValue* mosaic = reader.find("mosaic"); mosaic && !sensor.spectral)
    sensor.mosaic = read_mosaic(*mosaic, sensor.channels, context);
  if (const JsonValue* readout = reader.find("readout"))
    sensor.readout = read_readout(*readout, sensor.channels, context);
  reader.finish();
  return sensor;
}

}  // namespace abbe::description

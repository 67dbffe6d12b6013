#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/image.h"
#include "scene/description/pieces.h"

namespace abbe::description {
namespace {

constexpr Range kCount{1};
constexpr Range kPitch{0, 1e6, true, false};     // um
constexpr Range kExposure{0, 1e9, true, false};  // s

// Channels name the planes of an EXR, whose layers are separated by dots.
// As EXR files can name channels and what is said of them.
constexpr std::size_t kLongestName = 100;

bool is_plain(std::string_view name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kLongestName && std::all_of(name.begin(), name.end(), plain);
}

std::optional<ResponseKind> read_response(ObjectReader& reader, Reading& reading) {
  const JsonValue* json = reader.find("response");
  if (!json) return std::nullopt;
  const auto choice = read_choice(*json, "response", {"energy", "quantum"}, reading.diagnostics);
  if (!choice) return std::nullopt;
  return *choice == 0 ? ResponseKind::energy : ResponseKind::quantum;
}

/// What all channels of a sensor share.
struct Detector {
  ResponseKind kind = ResponseKind::energy;
  std::optional<Curve> quantum_efficiency;
};

std::optional<Detector> read_detector(ObjectReader& reader, Reading& reading) {
  Detector detector;
  const auto response = read_response(reader, reading);
  if (response) detector.kind = *response;
  const JsonValue* efficiency = reader.find("quantum_efficiency");
  if (!efficiency) return detector;
  if (response == ResponseKind::energy)
    reading.diagnostics.error(efficiency->where,
                              "a quantum_efficiency makes the response quantum (got \"energy\")");
  detector.kind = ResponseKind::quantum;
  detector.quantum_efficiency = read_curve(*efficiency, {"camera", Range::non_negative()}, reading);
  if (!detector.quantum_efficiency) return std::nullopt;
  return detector;
}

std::optional<Channel> read_channel(const std::string& name, const JsonValue& json, const Detector& detector,
                                    Reading& reading) {
  if (!is_plain(name)) {
    reading.diagnostics.error(
        json.where, fmt::format("a channel's name has up to {} letters, digits, - and _ only (got \"{}\")",
                                kLongestName, name));
    return std::nullopt;
  }
  std::optional<Curve> curve = read_curve(json, {"filter"}, reading);
  if (!curve) return std::nullopt;
  if (detector.quantum_efficiency) curve = product(*curve, *detector.quantum_efficiency);
  if (curve->max() == 0 && curve->min() == 0) {
    reading.diagnostics.error(json.where,
                              fmt::format("channel \"{}\" responds to no wavelength in [{}, {}] nm", name,
                                          kMinWavelengthNm, kMaxWavelengthNm));
    return std::nullopt;
  }
  if (detector.kind == ResponseKind::quantum) return quantum_channel(name, *curve);
  return energy_channel(name, std::move(*curve));
}

std::vector<Channel> read_channels(const JsonValue& json, const std::optional<Detector>& detector,
                                   Reading& reading) {
  const auto* members = std::get_if<JsonValue::Object>(&json.value);
  if (!members || members->empty()) {
    reading.diagnostics.error(
        json.where, fmt::format("expected channels by name (got {})", members ? "none" : json.kind()));
    return {};
  }
  std::vector<Channel> channels;
  if (!detector) return channels;
  for (const auto& [name, value] : *members)
    if (auto channel = read_channel(name, value, *detector, reading)) channels.push_back(std::move(*channel));
  return channels;
}

std::vector<Channel> read_observer(const JsonValue& json, Reading& reading) {
  const auto* year = std::get_if<double>(&json.value);
  const auto name = year ? std::optional(fmt::format("{}", *year)) : read_string(json, reading.diagnostics);
  if (!name) return {};
  if (*name == "1931") return observer_channels(Observer::cie1931);
  if (*name == "1964") return observer_channels(Observer::cie1964);
  reading.diagnostics.error(json.where,
                            unknown_name("observer", *name, std::vector<std::string>{"1931", "1964"}));
  return {};
}

std::vector<Channel> read_camera_channels(const JsonValue& json, Reading& reading) {
  const std::optional<std::string> name = reading.table(json);
  if (!name) return {};
  return load_camera(*name, json.where, reading.diagnostics).value_or(std::vector<Channel>{});
}

std::vector<Channel> read_what_it_counts(ObjectReader& reader, Reading& reading) {
  const auto key = reader.exactly_one({"channels", "camera", "observer"});
  const std::optional<Detector> detector = read_detector(reader, reading);
  if (!key) return {};
  const JsonValue& json = *reader.find(*key);
  if (*key == "channels") return read_channels(json, detector, reading);
  for (const char* own : {"response", "quantum_efficiency"})
    if (const JsonValue* at = reader.find(own))
      reading.diagnostics.error(at->where,
                                fmt::format("{} goes with channels (got {}, which has its own)", own, *key));
  return *key == "camera" ? read_camera_channels(json, reading) : read_observer(json, reading);
}

void read_resolution(ObjectReader& reader, bool probe, Sensor& sensor, Reading& reading) {
  const JsonValue* json = probe ? reader.find("resolution") : reader.require("resolution");
  if (!json || !read_numbers(*json, 2, Range::any(), reading.diagnostics)) return;
  const auto& edges = std::get<JsonValue::Array>(json->value);
  const auto width = read_integer(edges[0], kCount, reading.diagnostics);
  const auto height = read_integer(edges[1], kCount, reading.diagnostics);
  if (!width || !height) return;
  if (std::max(*width, *height) > kMaxImageEdge ||
      static_cast<std::size_t>(*width * *height) > kMaxImagePixels) {
    reading.diagnostics.error(
        json->where,
        fmt::format("too many pixels (got {} x {}, allowed edges up to {} and {} pixels in all)", *width,
                    *height, kMaxImageEdge, kMaxImagePixels),
        ErrorCode::resource);
    return;
  }
  sensor.width = static_cast<int>(*width);
  sensor.height = static_cast<int>(*height);
}

}  // namespace

Sensor read_sensor(const JsonValue& json, bool probe, Reading& reading) {
  Sensor sensor;
  ObjectReader reader(json, reading.diagnostics);
  read_resolution(reader, probe, sensor, reading);
  sensor.pixel_pitch = reader.number_or("pixel_pitch_um", sensor.pixel_pitch * 1e6, kPitch) * 1e-6;
  sensor.exposure_s = reader.number_or("exposure_s", sensor.exposure_s, kExposure);
  sensor.channels = read_what_it_counts(reader, reading);
  if (const JsonValue* readout = reader.find("readout"))
    sensor.readout = read_readout(*readout, sensor.channels, reading);
  reader.finish();
  return sensor;
}

}  // namespace abbe::description

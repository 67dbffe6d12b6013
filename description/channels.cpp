#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "description/curve.h"
#include "description/sensor.h"
#include "description/values.h"

namespace abbe::description {
namespace {

// Above 1 by what a measurement may err, far below a percentage.
constexpr Range kTransmittance{0, 1.05};
constexpr Range kQuantumEfficiency{0, 10};  // above 1 for energetic photons; per cent are more
constexpr Range kEffectiveIndex{1, 10};

// As EXR files can name channels and what is said of them.
constexpr std::size_t kLongestName = 100;

// Channels name the planes of an EXR, whose layers are separated by dots.
bool is_plain(std::string_view name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kLongestName && std::all_of(name.begin(), name.end(), plain);
}

std::optional<ResponseKind> read_response(ObjectReader& reader, LoadContext& context) {
  const JsonValue* json = reader.find("response");
  if (!json) return std::nullopt;
  const auto choice = read_choice(*json, "response", {"energy", "quantum"}, context.diagnostics);
  if (!choice) return std::nullopt;
  return *choice == 0 ? ResponseKind::energy : ResponseKind::quantum;
}

/// What all channels of a sensor share.
struct Detector {
  std::optional<ResponseKind> response;
  std::optional<Curve> quantum_efficiency;
  std::optional<FilterStack> filters;  ///< Before all channels: the lens, and what lies over the sensor.
  double exposure_s = 1;
};

// Puts one more filter into the stack: a curve, or one that shifts with the angle.
bool read_filter(const JsonValue& json, FilterStack& stack, LoadContext& context) {
  if (!json.find("effective_index") && !json.find("transmittance")) {
    const auto curve = read_curve(json, {"filter", kTransmittance}, context);
    if (curve) stack.fixed = product(stack.fixed, *curve);
    return curve.has_value();
  }
  ObjectReader reader(json, context.diagnostics);
  const auto index = reader.require_number("effective_index", kEffectiveIndex);
  const JsonValue* transmittance = reader.require("transmittance");
  reader.finish();
  if (!index || !transmittance) return false;
  auto curve = read_curve(*transmittance, {"filter", kTransmittance}, context);
  if (!curve) return false;
  stack.shifting.push_back({*std::move(curve), *index});
  return true;
}

std::optional<FilterStack> read_filters(const JsonValue& json, LoadContext& context) {
  const JsonValue::Array* list = read_array(json, "filters", 0, context.diagnostics);
  if (!list) return std::nullopt;
  FilterStack stack;
  bool complete = true;
  for (const JsonValue& entry : *list) complete = read_filter(entry, stack, context) && complete;
  return complete ? std::optional(std::move(stack)) : std::nullopt;
}

// Nothing after an error.
std::optional<Detector> read_detector(ObjectReader& reader, double exposure_s, LoadContext& context) {
  Detector detector{read_response(reader, context), {}, {}, exposure_s};
  const JsonValue* efficiency = reader.find("quantum_efficiency");
  const JsonValue* filters = reader.find("filters");
  const JsonValue* lens = reader.find("lens_transmission");
  if (efficiency && detector.response == ResponseKind::energy)
    context.diagnostics.error(efficiency->where,
                              "a quantum_efficiency makes the response quantum (got \"energy\")");
  if (efficiency)
    detector.quantum_efficiency = read_curve(*efficiency, {"camera", kQuantumEfficiency}, context);
  if (filters) detector.filters = read_filters(*filters, context);
  const auto transmission =
      lens ? read_curve(*lens, {"filter", kTransmittance}, context) : std::optional<Curve>();
  if ((efficiency && !detector.quantum_efficiency) || (filters && !detector.filters) ||
      (lens && !transmission))
    return std::nullopt;
  if (transmission) {
    if (!detector.filters) detector.filters.emplace();
    detector.filters->fixed = product(detector.filters->fixed, *transmission);
  }
  return detector;
}

/// What is said of a channel alone.
struct Own {
  Curve curve = Curve(1.0);
  FilterStack filters = {};
  double exposure_s;
};

// Either a curve, or filters perhaps with an exposure time.
std::optional<Own> read_own(const JsonValue& json, const Detector& detector, LoadContext& context) {
  Own own{.exposure_s = detector.exposure_s};
  const JsonValue* filters = json.find("filters");
  if (!filters) {
    auto curve = read_curve(json, {"filter"}, context);
    if (!curve) return std::nullopt;
    own.curve = *std::move(curve);
    return own;
  }
  ObjectReader reader(json, context.diagnostics);
  auto stack = read_filters(*reader.find("filters"), context);
  own.exposure_s = reader.number_or("exposure_s", own.exposure_s, kExposure);
  reader.finish();
  if (!stack) return std::nullopt;
  own.curve = std::exchange(stack->fixed, Curve(1.0));
  own.filters = *std::move(stack);
  return own;
}

std::optional<Channel> read_channel(const std::string& name, const JsonValue& json, const Detector& detector,
                                    LoadContext& context) {
  if (!is_plain(name)) {
    context.diagnostics.error(
        json.where, fmt::format("a channel's name has up to {} letters, digits, - and _ only (got \"{}\")",
                                kLongestName, name));
    return std::nullopt;
  }
  std::optional<Own> own = read_own(json, detector, context);
  if (!own) return std::nullopt;
  Curve& curve = own->curve;
  if (detector.quantum_efficiency) curve = product(curve, *detector.quantum_efficiency);
  const bool quantum = detector.quantum_efficiency || detector.response == ResponseKind::quantum;
  Channel channel = quantum ? quantum_channel(name, curve) : energy_channel(name, std::move(curve));
  if (!own->filters.shifting.empty()) channel = behind(std::move(channel), own->filters);
  if (own->exposure_s != detector.exposure_s)
    channel = exposed(std::move(channel), own->exposure_s / detector.exposure_s);
  return channel;
}

std::vector<Channel> read_named(const JsonValue& json, const std::optional<Detector>& detector,
                                LoadContext& context) {
  const auto* members = std::get_if<JsonValue::Object>(&json.value);
  if (!members || members->empty()) {
    context.diagnostics.error(
        json.where, fmt::format("expected channels by name (got {})", members ? "none" : json.kind()));
    return {};
  }
  std::vector<Channel> channels;
  if (!detector) return channels;
  for (const auto& [name, value] : *members)
    if (auto channel = read_channel(name, value, *detector, context)) channels.push_back(std::move(*channel));
  return channels;
}

std::vector<Channel> read_observer(const JsonValue& json, LoadContext& context) {
  const auto* year = std::get_if<double>(&json.value);
  const auto name = year ? std::optional(fmt::format("{}", *year)) : read_string(json, context.diagnostics);
  if (!name) return {};
  if (*name == "1931") return observer_channels(Observer::cie1931);
  if (*name == "1964") return observer_channels(Observer::cie1964);
  context.diagnostics.error(json.where,
                            unknown_name("observer", *name, std::vector<std::string>{"1931", "1964"}));
  return {};
}

std::vector<Channel> read_camera_channels(const JsonValue& json, const std::optional<Detector>& detector,
                                          LoadContext& context) {
  const std::optional<std::string> name = context.table(json);
  if (!name || !detector) return {};
  return load_camera(*name, json.where, context.diagnostics, detector->response)
      .value_or(std::vector<Channel>{});
}

// Responses that others have themselves.
void refuse(ObjectReader& reader, std::initializer_list<const char*> keys, const std::string& instead,
            LoadContext& context) {
  for (const char* key : keys)
    if (const JsonValue* at = reader.find(key))
      context.diagnostics.error(
          at->where, fmt::format("{} goes with channels (got {}, which has its own)", key, instead));
}

void require_response(const Channel& channel, const SourcePosition& where, LoadContext& context) {
  if (envelope(channel).max() == 0 && envelope(channel).min() == 0)
    context.diagnostics.error(where, fmt::format("channel \"{}\" responds to no wavelength in [{}, {}] nm",
                                                 channel.name, kMinWavelengthNm, kMaxWavelengthNm));
}

}  // namespace

void read_channels(ObjectReader& reader, Sensor& sensor, LoadContext& context) {
  const auto key = reader.exactly_one({"channels", "camera", "observer", "spectral"});
  const std::optional<Detector> detector = read_detector(reader, sensor.exposure_s, context);
  if (!key) return;
  const JsonValue& json = *reader.find(*key);
  if (*key == "channels") {
    sensor.channels = read_named(json, detector, context);
  } else if (*key == "camera") {
    refuse(reader, {"quantum_efficiency"}, *key, context);
    sensor.channels = read_camera_channels(json, detector, context);
  } else if (*key == "spectral") {
    refuse(reader, {"response", "quantum_efficiency", "filters", "lens_transmission", "mosaic"}, *key,
           context);
    sensor.spectral = read_spectral(json, context);
    if (sensor.spectral) sensor.channels = spectral_channels(*sensor.spectral);
  } else {
    refuse(reader, {"response", "quantum_efficiency"}, *key, context);
    sensor.channels = read_observer(json, context);
  }
  for (Channel& channel : sensor.channels) {
    if (detector && detector->filters) channel = behind(std::move(channel), *detector->filters);
    limit_angles(channel, 0);
    const JsonValue* own = json.find(channel.name);
    require_response(channel, own ? own->where : json.where, context);
  }
}

}  // namespace abbe::description

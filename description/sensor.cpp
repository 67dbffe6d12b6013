#include "description/sensor.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "description/value_ranges.h"
#include "io/data_directory.h"
#include "io/image.h"
#include "io/json_values.h"
#include "io/text.h"
#include "sensor/readout/speed.h"
#include "sensor/response/polarised_channels.h"

namespace abbe::spec {

using namespace schema;

namespace {

// Above 1 by what a measurement may err, far below a percentage.
constexpr Range kEffectiveIndex{1, 10};
constexpr Range kPixels{1};
constexpr Range kPitch{0, 1e6, true, false, "um"};
constexpr Range kFill{0, 1, true, false};
constexpr Range kPeak{0, 10, true, false};  // as of a quantum efficiency
constexpr Range kStep = Range{0.01, kMaxWavelengthNm - kMinWavelengthNm}.in("nm");

ValueType filters() {
  return list<Filter>(
      forms<Filter>("filter", "a filter",
                    form<InterferenceFilter>(Json::object, {"transmittance", "effective_index"}),
                    form<Curve>(Json::any)),
      "filters", 0);
}

ValueType channels() {
  return by_name<ChannelResponse>(
      forms<ChannelResponse>("channel", "a channel",
                             form<FilteredChannel>(Json::object, {"filters", "polariser"}),
                             form<Curve>(Json::any)),
      "channels by name", 1);
}

ValueType mosaic() {
  using Row = Located<std::vector<Located<std::string>>>;
  return list<Row>(list<Located<std::string>>("channels' names", 1), "rows", 1);
}

}  // namespace

static Fields fields(Tag<Shutter>) {
  constexpr Range kSeconds = Range{0, 1e9}.in("s");
  constexpr Range kFraction{0, 1};
  using Knot = std::array<double, 2>;
  return describe(
      "shutter", "Times and transmission of the rows of the sensor; each row is open for `exposure_s`.",
      {defaulted("open_s", &Shutter::open_s, Range{-1e9, 1e9}.in("s"),
                 "Time at which the first row opens, on the clock of keyframes."),
       defaulted("rise_s", &Shutter::rise_s, kSeconds, "Time to open, at a constant rate."),
       defaulted("fall_s", &Shutter::fall_s, kSeconds, "Time to close, at a constant rate."),
       field("transmission", &Shutter::transmission, list<Knot>(vector<Knot>(kFraction), "pairs", 2),
             "Replaces both: pairs of the elapsed fraction of `exposure_s`, from 0 to 1, and the "
             "transmittance at that time, linearly interpolated."),
       defaulted("row_delay_s", &Shutter::row_delay_s, kSeconds,
                 "Delay of each row after the row above it, as in a rolling shutter.")});
}

static Fields fields(Tag<InterferenceFilter>) {
  return describe("interference_filter",
                  "A filter whose curve shifts to shorter wavelengths with the angle of incidence.",
                  {field("effective_index", &InterferenceFilter::effective_index, kEffectiveIndex,
                         "At an angle of incidence t, the wavelengths of the curve are multiplied by sqrt(1 "
                         "- sin(t)^2/n^2)."),
                   field("transmittance", &InterferenceFilter::transmittance,
                         "Transmittance at normal incidence, in [0, 1.05].")});
}

static Fields fields(Tag<PolarisingFilter>) {
  return describe(
      "polarising_filter", "A linear polariser in front of the film.",
      {field("angle_deg", &PolarisingFilter::angle_deg, kAngle,
             "Angle of the transmission axis, from the right of the picture towards up."),
       field("transmittance", &PolarisingFilter::transmittance,
             "Transmittance of light polarised along that axis, in [0, 1.05]; 1 if absent."),
       field("extinction_ratio", &PolarisingFilter::extinction_ratio,
             "Transmittance along the axis over that across it, from 1 to 1e9; infinite if absent.")});
}

static Fields fields(Tag<FilteredChannel>) {
  return describe(
      "filtered_channel", "A channel with its own filters or its own polariser.",
      {field("filters", &FilteredChannel::filters, filters(), "Filters in series."),
       field("polariser", &FilteredChannel::polariser, "Polariser in front of the filters of this channel."),
       field("exposure_s", &FilteredChannel::exposure_s, kExposure,
             "Exposure time of this channel; that of the sensor if absent.")},
      {"filters", "polariser"});
}

Fields fields(Tag<Bins>) {
  return describe("spectral",
                  "Wavelength bins that fill a range, 2 to 1000 of them. The film then records radiances.",
                  {field("from_nm", &Bins::from_nm, kWavelength, "Lower end of the first bin."),
                   field("to_nm", &Bins::to_nm, kWavelength, "Upper end of the last bin."),
                   field("step_nm", &Bins::step_nm, kStep, "Width of each bin.")});
}

Fields fields(Tag<Sensor>) {
  return describe(
      "sensor", "Pixels, spectral responses and readout of the sensor.",
      {field("model", &Sensor::model,
             "A camera sensor: its name in data/sensor, or FILE.json. Its keys apply where they are absent "
             "here."),
       field("resolution", &Sensor::resolution, vector<std::array<std::int64_t, 2>>(kPixels),
             "[width, height] in pixels, at most 65536 each and 2^28 in all; [1, 1] for a probe if absent."),
       defaulted("pixel_pitch_um", &Sensor::pixel_pitch_um, kPitch, "Distance between pixels."),
       defaulted("exposure_s", &Sensor::exposure_s, kExposure, "Exposure time."),
       field("shutter", &Sensor::shutter,
             "Shutter of the rows; if absent all rows are open for the exposure time."),
       defaulted("fill_factor", &Sensor::fill_factor, kFill,
                 "Fraction of the pixel area that is sensitive to light."),
       at_most_one(
           &Sensor::counts, "a sensor has one of channels, camera, observer and spectral",
           under<Channels>("channels", channels(), "Response of each channel by name, or its filters."),
           under<MeasuredCamera>("camera", "A measured camera: its name in data/camera, or FILE.csv."),
           under<StandardObserver>("observer", enumeration<Observer>("observer", {"1931", "1964"}, true),
                                   "A CIE standard observer: channels X, Y and Z."),
           under<Bins>("spectral")),
       field("response", &Sensor::response, enumeration<ResponseKind>("response", {"energy", "quantum"}),
             "Kind of response of the channels or of a camera's curves: per unit of energy, or per photon. "
             "quantum if `quantum_efficiency` is given."),
       field("quantum_efficiency", &Sensor::quantum_efficiency,
             "Electrons per photon, in [0, 10], a factor of every channel."),
       field("peak_quantum_efficiency", &Sensor::peak_quantum_efficiency, kPeak,
             "Electrons per photon of the most sensitive channel at its maximum. It converts relative "
             "responses, such as those of `camera`, to quantum efficiencies with a common scale."),
       field("electrons_per_lx_s", &Sensor::electrons_per_lx_s, Range::positive(),
             "The same scale, given as electrons per lx s of daylight (D55) on the sensor for a pixel of the "
             "most sensitive channel. Filters and lens transmission are included."),
       field("filters", &Sensor::filters, filters(), "Filters in series in front of all channels."),
       field("lens_transmission", &Sensor::lens_transmission, "Transmittance of the lens, in [0, 1.05]."),
       field("polariser", &Sensor::polariser, "Polariser in front of all channels."),
       field("stokes", &Sensor::stokes,
             "True to measure Stokes vectors: the components of channel C are C (the intensity), S1.C, S2.C "
             "and S3.C."),
       field("mosaic", &Sensor::mosaic, mosaic(),
             "Channels of the pixels: rows of a pattern that repeats from the top left corner."),
       field("readout", &Sensor::readout)},
      {"model", "channels", "camera", "observer", "spectral"});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

std::vector<Shutter::Knot> knots_of(const schema::Located<std::vector<std::array<double, 2>>>& spec,
                                    const LoadContext& context) {
  std::vector<Shutter::Knot> knots;
  double transmitted = 0;
  for (const auto& [at, passes] : spec.value) {
    if (!knots.empty() && at < knots.back().time) {
      context.diagnostics.error(
          spec.where, fmt::format("fractions of the exposure time must increase (got {} after {})", at,
                                  knots.back().time));
      return {};
    }
    if (!knots.empty()) transmitted += (at - knots.back().time) * (passes + knots.back().transmittance);
    knots.push_back({at, passes});
  }
  if (knots.front().time == 0 && knots.back().time == 1 && transmitted > 0) return knots;
  context.diagnostics.error(
      spec.where,
      fmt::format(
          "a transmission must run from 0 to 1 and pass some light (got one from {} to {} with mean {:g})",
          knots.front().time, knots.back().time, transmitted / 2));
  return {};
}

// Times of the result are fractions of the exposure time. After an error the shutter is open throughout.
Shutter build(const spec::Shutter& spec, double exposure_s, int rows, const LoadContext& context) {
  std::vector<Shutter::Knot> knots;
  const double moving_s = spec.rise_s + spec.fall_s;
  if (spec.transmission && moving_s > 0)
    context.diagnostics.error(spec.transmission->where,
                              "a shutter has either rise_s and fall_s, or transmission");
  else if (spec.transmission)
    knots = knots_of(*spec.transmission, context);
  else if (moving_s > exposure_s)
    context.diagnostics.error(
        spec.where,
        fmt::format("a shutter must open and close within the exposure time (got {} s, allowed up to {} s)",
                    moving_s, exposure_s));
  else
    knots = {{0, spec.rise_s > 0 ? 0.0 : 1.0},
             {spec.rise_s / exposure_s, 1},
             {1 - spec.fall_s / exposure_s, 1},
             {1, spec.fall_s > 0 ? 0.0 : 1.0}};
  if (knots.empty()) return {};
  return Shutter(std::move(knots), spec.row_delay_s / exposure_s, rows);
}

void build_resolution(const spec::Sensor& spec, bool probe, Sensor& sensor, LoadContext& context) {
  if (!spec.resolution) {
    if (!probe) context.diagnostics.error(spec.where, "missing key \"resolution\"");
    return;
  }
  const auto [width, height] = spec.resolution->value;
  if (std::max(width, height) > kMaxImageEdge || static_cast<std::size_t>(width * height) > kMaxImagePixels) {
    context.diagnostics.error(
        spec.resolution->where,
        fmt::format("too many pixels (got {} x {}, allowed edges up to {} and {} pixels in all)", width,
                    height, kMaxImageEdge, kMaxImagePixels),
        ErrorCode::resource);
    return;
  }
  sensor.width = static_cast<int>(width);
  sensor.height = static_cast<int>(height);
}

std::optional<Mosaic> build_mosaic(const spec::Sensor& spec, const std::vector<Channel>& channels,
                                   LoadContext& context) {
  if (channels.empty()) return std::nullopt;  // The channels' errors have been reported.
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  const auto& rows = spec.mosaic->value;
  Mosaic mosaic{static_cast<int>(rows.front().value.size()), static_cast<int>(rows.size()), {}};
  for (const auto& row : rows) {
    if (row.value.size() != static_cast<std::size_t>(mosaic.width))
      return context.refuse(row.where,
                            fmt::format("rows of a mosaic must have the same length (got {}, allowed {})",
                                        row.value.size(), mosaic.width));
    for (const auto& cell : row.value) {
      const auto known = std::ranges::find(names, cell.value);
      if (known != names.end())
        mosaic.channel.push_back(static_cast<int>(known - names.begin()));
      else
        context.diagnostics.error(cell.where, unknown_name("channel", cell.value, names));
    }
  }
  if (mosaic.channel.size() != rows.size() * static_cast<std::size_t>(mosaic.width)) return std::nullopt;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::ranges::count(mosaic.channel, static_cast<int>(i)) == 0)
      context.diagnostics.error(spec.mosaic->where, fmt::format("does not contain channel \"{}\"", names[i]));
  return mosaic;
}

// Builds the readout. Its channels must count electrons.
std::optional<Readout> build_readout(const spec::Sensor& spec, const Sensor& sensor,
                                     const LoadContext& context) {
  for (const Channel& channel : sensor.channels)
    if (channel.kind != ResponseKind::quantum)
      context.diagnostics.error(
          spec.readout->where,
          fmt::format("a readout needs channels that count electrons (got \"{}\" with an energy response, "
                      "allowed quantum; peak_quantum_efficiency converts it)",
                      channel.name));
  if (sensor.channels.empty()) return std::nullopt;  // Their errors have been reported.
  const double area_m2 = gathering_area(sensor.pixel_pitch, sensor.fill_factor);
  return abbe::build(spec.readout->value, daylight_sensitivity(sensor.channels, area_m2),
                     context.diagnostics);
}

// Peak quantum efficiency of channels of which at least one responds.
double peak_efficiency(const std::vector<Channel>& channels) {
  const std::vector<Channel> normalised = with_peak_efficiency(channels, 1);
  double peak = 0;
  for (std::size_t k = 0; k < channels.size(); ++k)
    if (normalised[k].weight.max() > 0) peak = channels[k].weight.max() / normalised[k].weight.max();
  return peak;
}

// Scales the channels so that the most sensitive one counts `electrons_per_lx_s` in daylight.
void scale_to_sensitivity(const spec::Sensor& spec, Sensor& sensor, LoadContext& context) {
  if (!spec.electrons_per_lx_s || sensor.channels.empty()) return;
  const double area_m2 = gathering_area(sensor.pixel_pitch, sensor.fill_factor);
  const std::optional<double> counted = daylight_sensitivity(sensor.channels, area_m2);
  if (!counted || !(*counted > 0)) return;  // The channels' errors have been reported.
  for (Channel& channel : sensor.channels)
    channel = scaled(std::move(channel), spec.electrons_per_lx_s->value / *counted);
  if (const double peak = peak_efficiency(sensor.channels); peak > spec::kPeak.high)
    context.diagnostics.error(spec.electrons_per_lx_s->where,
                              fmt::format("requires {:.3g} electrons per photon (allowed up to {:g}): a "
                                          "pixel of {:g} um counts at most {:.4g} electrons per lx s",
                                          peak, spec::kPeak.high, spec.pixel_pitch_um,
                                          spec.electrons_per_lx_s->value * spec::kPeak.high / peak));
}

// Warns if the table of daylight ends within the response of channels that it scales, or whose gain it sets.
void check_scale(const spec::Sensor& spec, const Sensor& sensor, LoadContext& context) {
  const auto* iso = spec.readout ? std::get_if<spec::IsoSpeed>(&spec.readout->value.conversion) : nullptr;
  if (spec.electrons_per_lx_s)
    check_daylight(sensor.channels, spec.electrons_per_lx_s->where, context.diagnostics);
  else if (iso != nullptr)
    check_daylight(sensor.channels, iso->where, context.diagnostics);
}

namespace fs = std::filesystem;

// Keys that set the same property: one of them in a scene replaces all of them in a file.
using Keys = std::span<const std::string_view>;
constexpr std::array<std::string_view, 9> kCounts{"channels",
                                                  "camera",
                                                  "observer",
                                                  "spectral",
                                                  "mosaic",
                                                  "response",
                                                  "quantum_efficiency",
                                                  "peak_quantum_efficiency",
                                                  "electrons_per_lx_s"};
constexpr Keys kWhatCounts = Keys(kCounts).first(4);
constexpr Keys kScale = Keys(kCounts).last(2);
constexpr std::array<std::string_view, 2> kConversion{"gain_e_per_dn", "iso"};

std::optional<fs::path> model_file(const std::string& name, const SourcePosition& where,
                                   LoadContext& context) {
  if (name.ends_with(".json")) return context.file(name, where);
  const std::vector<std::string> names = shipped_names("sensor");
  if (std::ranges::find(names, name) == names.end())
    return context.refuse(where, unknown_name("sensor", name, names));
  context.remember(data_directory() / "sensor" / (name + ".json"));
  return context.files.back();
}

// The member `sensor` of a model file. Reports missing keys, including those of its provenance.
std::optional<JsonValue> read_model(const fs::path& path, LoadContext& context) {
  const auto source = read_text(path, context.diagnostics);
  std::optional<JsonValue> root = source ? parse_json(source, context.diagnostics) : std::nullopt;
  if (!root) return std::nullopt;
  bool complete = true;
  for (const char* key : {"title", "source", "status", "sensor"})
    if (root->find(key) == nullptr) {
      context.diagnostics.error(root->where, fmt::format("missing key \"{}\"", key), ErrorCode::input);
      complete = false;
    }
  return complete ? std::optional(std::move(*root->find("sensor"))) : std::nullopt;
}

bool has_any(const JsonValue& object, Keys keys) {
  return std::ranges::any_of(keys, [&](auto key) { return object.find(key) != nullptr; });
}

// Keys of the file that the scene's sensor replaces together.
Keys replaced_by(const JsonValue& sensor) {
  if (has_any(sensor, kWhatCounts)) return kCounts;
  if (has_any(sensor, kScale)) return kScale;
  return {};
}

// Adds to `own` the members of `file` that it lacks, except those in `replaced`.
void complete(JsonValue& own, JsonValue& file, Keys replaced) {
  auto* const members = std::get_if<JsonValue::Object>(&file.value);
  auto* const mine = std::get_if<JsonValue::Object>(&own.value);
  if (members == nullptr || mine == nullptr) return;
  for (JsonValue::Member& member : *members)
    if (own.find(member.first) == nullptr &&
        std::find(replaced.begin(), replaced.end(), member.first) == replaced.end())
      mine->push_back(std::move(member));
}

}  // namespace

Sensor build(const spec::Sensor& spec, bool probe, LoadContext& context) {
  Sensor sensor;
  build_resolution(spec, probe, sensor, context);
  sensor.pixel_pitch = spec.pixel_pitch_um * 1e-6;
  sensor.exposure_s = spec.exposure_s;
  if (spec.shutter) sensor.shutter = build(*spec.shutter, sensor.exposure_s, sensor.height, context);
  sensor.fill_factor = spec.fill_factor;
  build_channels(spec, sensor, context);
  // Polarisation is recorded in the frame of a picture, which a probe does not have.
  if (probe && any_analyser(sensor.channels))
    context.diagnostics.error(spec.where, "an irradiance probe does not record polarisation");
  scale_to_sensitivity(spec, sensor, context);
  check_scale(spec, sensor, context);
  if (spec.model && std::holds_alternative<std::monostate>(spec.counts))
    context.diagnostics.error(spec.where,
                              "neither the model nor the scene defines the channels of the sensor");
  if (spec.mosaic && !sensor.spectral) sensor.mosaic = build_mosaic(spec, sensor.channels, context);
  if (spec.readout) sensor.readout = build_readout(spec, sensor, context);
  return sensor;
}

void include_sensor_model(JsonValue& scene, LoadContext& context) {
  JsonValue* const sensor = scene.find("sensor");
  const JsonValue* const model = sensor != nullptr ? sensor->find("model") : nullptr;
  const auto* const name = model != nullptr ? std::get_if<std::string>(&model->value) : nullptr;
  if (name == nullptr) return;  // Other values are reported when the scene is read.
  const auto path = model_file(*name, model->where, context);
  std::optional<JsonValue> file = path ? read_model(*path, context) : std::nullopt;
  if (!file) return;
  JsonValue* const own = sensor->find("readout");
  JsonValue* const others = file->find("readout");
  if (own != nullptr && others != nullptr)
    complete(*own, *others, has_any(*own, kConversion) ? Keys(kConversion) : Keys());
  complete(*sensor, *file, replaced_by(*sensor));
}

}  // namespace abbe::description

#include "description/sensor.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/image.h"
#include "sensor/readout/speed.h"
#include "sensor/response/stokes_channels.h"

namespace abbe::spec {
namespace {

using namespace schema;

// Above 1 by what a measurement may err, far below a percentage.
constexpr Range kEffectiveIndex{1, 10};
constexpr Range kPixels{1};
constexpr Range kPitch{0, 1e6, true, false, "um"};
constexpr Range kFill{0, 1, true, false};
constexpr Range kPeak{0, 10, true, false};  // as of a quantum efficiency
constexpr Range kStep = Range{0.01, kMaxWavelengthNm - kMinWavelengthNm}.in("nm");

Kind filters() {
  return list<Filter>(
      forms<Filter>("filter", "a filter",
                    form<InterferenceFilter>(Json::object, {"transmittance", "effective_index"}),
                    form<Curve>(Json::any)),
      "filters", 0);
}

Kind channels() {
  return by_name<ChannelResponse>(
      forms<ChannelResponse>("channel", "a channel",
                             form<FilteredChannel>(Json::object, {"filters", "polariser"}),
                             form<Curve>(Json::any)),
      "channels by name", 1);
}

Kind mosaic() {
  using Row = Located<std::vector<Located<std::string>>>;
  return list<Row>(list<Located<std::string>>("channels' names", 1), "rows", 1);
}

}  // namespace

static Fields fields(Tag<InterferenceFilter>) {
  return describe("interference_filter", "A filter that shifts to the blue with the angle of incidence.",
                  {field("effective_index", &InterferenceFilter::effective_index, kEffectiveIndex,
                         "At an angle t of incidence the curve is stretched by sqrt(1 - sin(t)^2/n^2)."),
                   field("transmittance", &InterferenceFilter::transmittance,
                         "Transmittance along the normal, in [0, 1.05].")});
}

static Fields fields(Tag<PolarisingFilter>) {
  return describe(
      "polarising_filter", "A polariser for linearly polarised light, before the film.",
      {field("angle_deg", &PolarisingFilter::angle_deg, kAngle,
             "Of the axis along which it lets light pass: from the right of the picture towards up."),
       field("transmittance", &PolarisingFilter::transmittance,
             "Of light polarised along that axis, in [0, 1.05]; 1 when absent."),
       field("extinction_ratio", &PolarisingFilter::extinction_ratio,
             "That transmittance over the one of light polarised across the axis, from 1 to 1e9; infinite "
             "when absent.")});
}

static Fields fields(Tag<FilteredChannel>) {
  return describe(
      "filtered_channel", "A channel behind filters of its own, or behind a polariser.",
      {field("filters", &FilteredChannel::filters, filters(), "The filters, one behind the other."),
       field("polariser", &FilteredChannel::polariser, "Before the filters of this channel alone."),
       field("exposure_s", &FilteredChannel::exposure_s, kExposure,
             "Exposure time of this channel; the sensor's when absent.")},
      {"filters", "polariser"});
}

Fields fields(Tag<Bins>) {
  return describe("spectral",
                  "Bins of wavelength that fill a range, 2 to 1000 of them: a film of them holds radiances.",
                  {field("from_nm", &Bins::from_nm, kWavelength, "Where the first bin begins."),
                   field("to_nm", &Bins::to_nm, kWavelength, "Where the last bin ends."),
                   field("step_nm", &Bins::step_nm, kStep, "Width of each bin.")});
}

Fields fields(Tag<Sensor>) {
  return describe(
      "sensor", "The pixels, and what they count.",
      {field("model", &Sensor::model,
             "A camera's sensor, by its name in data/sensor or as FILE.json, whose keys hold where there are "
             "none here."),
       field("resolution", &Sensor::resolution, vector<std::array<std::int64_t, 2>>(kPixels),
             "[width, height] in pixels, edges up to 65536 and 2^28 pixels in all; [1, 1] of a probe when "
             "absent."),
       defaulted("pixel_pitch_um", &Sensor::pixel_pitch_um, kPitch, "Distance between pixels."),
       defaulted("exposure_s", &Sensor::exposure_s, kExposure, "Exposure time."),
       field("shutter", &Sensor::shutter,
             "When its rows are open; all at once for the exposure time when absent."),
       defaulted("fill_factor", &Sensor::fill_factor, kFill, "Share of a pixel that takes light."),
       at_most_one(
           &Sensor::counts, "a sensor counts by one of channels, camera, observer and spectral",
           under<Channels>("channels", channels(), "Response of each channel by name, or its filters."),
           under<MeasuredCamera>("camera", "A measured camera, by its name in data/camera or as FILE.csv."),
           under<StandardObserver>("observer", word<Observer>("observer", {"1931", "1964"}, true),
                                   "A CIE standard observer: channels X, Y and Z."),
           under<Bins>("spectral")),
       field(
           "response", &Sensor::response, word<ResponseKind>("response", {"energy", "quantum"}),
           "What the channels, or a camera's curves, multiply; quantum when `quantum_efficiency` is given."),
       field("quantum_efficiency", &Sensor::quantum_efficiency,
             "Electrons per photon, in [0, 10], multiplied into every channel."),
       field("peak_quantum_efficiency", &Sensor::peak_quantum_efficiency, kPeak,
             "Electrons per photon of the most sensitive channel where it is most sensitive: measured "
             "responses "
             "of any scale, as of `camera`, become quantum efficiencies, scaled together."),
       field("electrons_per_lx_s", &Sensor::electrons_per_lx_s, Range::positive(),
             "The same scale by the electrons that a pixel of the most sensitive channel counts for each lx "
             "s of "
             "daylight (D55) on the sensor, filters and lens transmission included."),
       field("filters", &Sensor::filters, filters(), "Filters before every channel, one behind the other."),
       field("lens_transmission", &Sensor::lens_transmission,
             "Transmittance in [0, 1.05] before all filters."),
       field("polariser", &Sensor::polariser, "Before all channels."),
       field("stokes", &Sensor::stokes,
             "Whether every channel measures the Stokes vector of the light: C the intensity, S1.C, S2.C and "
             "S3.C the other components."),
       field("mosaic", &Sensor::mosaic, mosaic(),
             "Channels of single pixels, rows of a pattern that repeats from the top left corner."),
       field("readout", &Sensor::readout)},
      {"model", "channels", "camera", "observer", "spectral"});
}

}  // namespace abbe::spec

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
std::optional<Readout> build_readout(const spec::Sensor& said, const Sensor& sensor,
                                     const LoadContext& context) {
  for (const Channel& channel : sensor.channels)
    if (channel.kind != ResponseKind::quantum)
      context.diagnostics.error(
          said.readout->where,
          fmt::format("a read-out needs channels that count electrons (got \"{}\", whose response is "
                      "energy, allowed quantum; peak_quantum_efficiency makes it so)",
                      channel.name));
  if (sensor.channels.empty()) return std::nullopt;  // what is wrong with them is told
  const double area_m2 = gathering_area(sensor.pixel_pitch, sensor.fill_factor);
  return abbe::build(said.readout->value, daylight_sensitivity(sensor.channels, area_m2),
                     context.diagnostics);
}

// The greatest quantum efficiency of channels of which one at least responds.
double peak_efficiency(const std::vector<Channel>& channels) {
  const std::vector<Channel> of_one = with_peak_efficiency(channels, 1);
  double peak = 0;
  for (std::size_t k = 0; k < channels.size(); ++k)
    if (of_one[k].weight.max() > 0) peak = channels[k].weight.max() / of_one[k].weight.max();
  return peak;
}

// Makes the most sensitive channel count as many electrons in daylight as is said.
void scale_to_sensitivity(const spec::Sensor& said, Sensor& sensor, LoadContext& context) {
  if (!said.electrons_per_lx_s || sensor.channels.empty()) return;
  const double area_m2 = gathering_area(sensor.pixel_pitch, sensor.fill_factor);
  const std::optional<double> counted = daylight_sensitivity(sensor.channels, area_m2);
  if (!counted || !(*counted > 0)) return;  // what is wrong with the channels is told
  for (Channel& channel : sensor.channels)
    channel = scaled(std::move(channel), said.electrons_per_lx_s->value / *counted);
  if (const double peak = peak_efficiency(sensor.channels); peak > spec::kPeak.high)
    context.diagnostics.error(
        said.electrons_per_lx_s->where,
        fmt::format(
            "asks for {:.3g} electrons of a photon (allowed up to {:g}): a pixel of {:g} um counts at "
            "most {:.4g} per lx s",
            peak, spec::kPeak.high, said.pixel_pitch_um,
            said.electrons_per_lx_s->value * spec::kPeak.high / peak));
}

// Warns where daylight ends within what the channels count and the scene scales them or their gain by it.
void check_scale(const spec::Sensor& said, const Sensor& sensor, LoadContext& context) {
  const auto* iso = said.readout ? std::get_if<spec::IsoSpeed>(&said.readout->value.conversion) : nullptr;
  if (said.electrons_per_lx_s)
    check_daylight(sensor.channels, said.electrons_per_lx_s->where, context.diagnostics);
  else if (iso != nullptr)
    check_daylight(sensor.channels, iso->where, context.diagnostics);
}

// Polarisation is told in the frame of a picture.
void check_polarisation(const spec::Sensor& said, const Sensor& sensor, LoadContext& context) {
  if (any_analyser(sensor.channels))
    context.diagnostics.error(said.where, "a meter of irradiance tells no polarisation");
}

}  // namespace

Sensor build(const spec::Sensor& said, bool probe, LoadContext& context) {
  Sensor sensor;
  build_resolution(said, probe, sensor, context);
  sensor.pixel_pitch = said.pixel_pitch_um * 1e-6;
  sensor.exposure_s = said.exposure_s;
  if (said.shutter) sensor.shutter = build(*said.shutter, sensor.exposure_s, sensor.height, context);
  sensor.fill_factor = said.fill_factor;
  build_channels(said, sensor, context);
  if (probe) check_polarisation(said, sensor, context);
  scale_to_sensitivity(said, sensor, context);
  check_scale(said, sensor, context);
  if (said.model && std::holds_alternative<std::monostate>(said.counts))
    context.diagnostics.error(said.where, "neither the model nor the scene says what its pixels count");
  if (said.mosaic && !sensor.spectral) sensor.mosaic = build_mosaic(said, sensor.channels, context);
  if (said.readout) sensor.readout = build_readout(said, sensor, context);
  return sensor;
}

}  // namespace abbe::description

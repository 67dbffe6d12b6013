#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "description/load_context.h"
#include "description/sensor.h"
#include "sensor/response/polarised_channels.h"

namespace abbe::description {
namespace {

constexpr Range kExtinctionRatio{1, 1e9};

// Limit for the names of channels and attributes of EXR files.
constexpr std::size_t kMaxNameLength = 100;

constexpr int kMinBins = 2;  // Files give the width of bins as the distance of their centers.
constexpr int kMaxBins = 1000;

// True if the name can be that of an EXR plane. Dots are excluded, because they separate EXR layers.
bool is_plain(std::string_view name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kMaxNameLength && std::all_of(name.begin(), name.end(), plain);
}

/// Properties that all channels of a sensor have in common.
struct Detector {
  std::optional<ResponseKind> response = {};
  ResponseScale scale = ResponseScale::absolute;
  std::optional<Curve> quantum_efficiency = {};
  std::optional<FilterStack> filters =
      {};  ///< Filters in front of all channels, including the transmission of the lens.
  std::optional<Polariser> polariser = {};  ///< Polariser in front of all channels.
  double exposure_s = 1;
};

// Builds filters in series: curves, and filters that shift with the angle. Nothing after an error.
std::optional<FilterStack> build_filters(const spec::Filters& filters, LoadContext& context) {
  FilterStack stack;
  bool complete = true;
  for (const spec::Filter& filter : filters) {
    const auto* fixed = std::get_if<spec::Curve>(&filter);
    const auto* shifting = std::get_if<spec::InterferenceFilter>(&filter);
    auto curve = build(fixed ? *fixed : shifting->transmittance, kTransmittanceUse, context);
    complete = complete && curve;
    if (fixed && curve) stack.fixed = product(stack.fixed, *curve);
    if (shifting && curve) stack.shifting.push_back({*std::move(curve), shifting->effective_index});
  }
  return complete ? std::optional(std::move(stack)) : std::nullopt;
}

std::optional<Polariser> build_polariser(const spec::PolarisingFilter& spec, LoadContext& context) {
  Polariser polariser{spec.angle_deg};
  const auto& passing = spec.transmittance;
  const auto transmittance = passing ? build(*passing, kTransmittanceUse, context) : Curve(1.0);
  const auto& ratio = spec.extinction_ratio;
  if (ratio) polariser.extinction_ratio = build(*ratio, {"filter", kExtinctionRatio}, context);
  if (!transmittance || (ratio && !polariser.extinction_ratio)) return std::nullopt;
  polariser.transmittance = *transmittance;
  return polariser;
}

// Returns nothing after an error.
std::optional<Detector> build_detector(const spec::Sensor& spec, LoadContext& context) {
  Detector detector{.exposure_s = spec.exposure_s};
  if (spec.response) detector.response = spec.response->value;
  if (spec.peak_quantum_efficiency || spec.electrons_per_lx_s) detector.scale = ResponseScale::relative;
  const auto& efficiency = spec.quantum_efficiency;
  if (efficiency && detector.response == ResponseKind::energy)
    context.diagnostics.error(efficiency->where,
                              "quantum_efficiency requires a quantum response (got \"energy\")");
  if (efficiency) detector.quantum_efficiency = build(*efficiency, kQuantumEfficiencyUse, context);
  if (spec.filters) detector.filters = build_filters(spec.filters->value, context);
  if (spec.polariser) detector.polariser = build_polariser(*spec.polariser, context);
  const auto& lens = spec.lens_transmission;
  const auto transmission = lens ? build(*lens, kTransmittanceUse, context) : std::optional<Curve>();
  if ((efficiency && !detector.quantum_efficiency) || (spec.filters && !detector.filters) ||
      (spec.polariser && !detector.polariser) || (lens && !transmission))
    return std::nullopt;
  if (transmission) {
    if (!detector.filters) detector.filters.emplace();
    detector.filters->fixed = product(detector.filters->fixed, *transmission);
  }
  return detector;
}

/// Properties of one channel.
struct ChannelParts {
  Curve curve = Curve(1.0);
  FilterStack filters = {};
  std::optional<Polariser> polariser = {};
  double exposure_s;
};

bool is_quantum(const Detector& detector) {
  return detector.quantum_efficiency || detector.response == ResponseKind::quantum;
}

// Responses to energy have no declared unit, nor do responses that are scaled afterwards. With a quantum
// efficiency given separately, a response is the transmittance of the filter.
CurveUse response_use(const Detector& detector) {
  const bool filter = detector.quantum_efficiency.has_value();
  if (is_quantum(detector) && detector.scale == ResponseScale::absolute)
    return {"filter", kQuantumResponseUse.allowed, kQuantumResponseUse.unit, filter};
  const bool unknown_kind = !is_quantum(detector) && !detector.response;
  return {"filter", spec::kValue, unknown_kind ? CurveUnit::unknown_response : CurveUnit::any, filter};
}

// Builds a channel given as a curve, or as filters with an optional exposure time.
std::optional<ChannelParts> build_channel_parts(const spec::ChannelResponse& spec, const Detector& detector,
                                                LoadContext& context) {
  ChannelParts parts{.exposure_s = detector.exposure_s};
  if (const auto* response = std::get_if<spec::Curve>(&spec)) {
    auto curve = build(*response, response_use(detector), context);
    if (!curve) return std::nullopt;
    parts.curve = *std::move(curve);
    return parts;
  }
  const auto& filtered = std::get<spec::FilteredChannel>(spec);
  auto stack = build_filters(filtered.filters.value_or(spec::Filters{}), context);
  if (filtered.polariser) parts.polariser = build_polariser(*filtered.polariser, context);
  if (!stack || (filtered.polariser && !parts.polariser)) return std::nullopt;
  if (filtered.polariser && detector.polariser)
    context.diagnostics.error(
        filtered.polariser->where,
        "a channel cannot have a second polariser: the sensor already has one in front of all channels");
  parts.exposure_s = filtered.exposure_s.value_or(parts.exposure_s);
  parts.curve = std::exchange(stack->fixed, Curve(1.0));
  parts.filters = *std::move(stack);
  return parts;
}

std::optional<Channel> build_channel(const schema::Named<spec::ChannelResponse>& spec,
                                     const Detector& detector, LoadContext& context) {
  const std::string& name = spec.name;
  if (!is_plain(name))
    return context.refuse(
        spec.where,
        fmt::format("a channel name has at most {} characters: letters, digits, - and _ (got \"{}\")",
                    kMaxNameLength, name));
  std::optional<ChannelParts> parts = build_channel_parts(spec.value, detector, context);
  if (!parts) return std::nullopt;
  Curve& curve = parts->curve;
  if (detector.quantum_efficiency) curve = product(curve, *detector.quantum_efficiency);
  Channel channel =
      is_quantum(detector) ? quantum_channel(name, curve) : energy_channel(name, std::move(curve));
  if (!parts->filters.shifting.empty()) channel = behind(std::move(channel), parts->filters);
  if (parts->polariser) channel = behind(std::move(channel), *parts->polariser);
  if (parts->exposure_s != detector.exposure_s)
    channel = exposed(std::move(channel), parts->exposure_s / detector.exposure_s);
  return channel;
}

/// Builds the channels for each alternative of `spec::Sensor::counts`. A faulty detector has no channels.
struct ChannelBuilder {
  const spec::Sensor& sensor_spec;
  const std::optional<Detector>& detector;
  Sensor& sensor;
  LoadContext& context;

  // Reports a key that applies to `channels` only, if it is set, and not to the alternative `instead`.
  void refuse(const auto& value, const char* key, const char* instead) const {
    if (value)
      context.diagnostics.error(value->where,
                                fmt::format("{} is used with channels only (got {})", key, instead));
  }
  void refuse_responses(const char* instead) const {
    refuse(sensor_spec.response, "response", instead);
    refuse(sensor_spec.quantum_efficiency, "quantum_efficiency", instead);
    refuse(sensor_spec.peak_quantum_efficiency, "peak_quantum_efficiency", instead);
    refuse(sensor_spec.electrons_per_lx_s, "electrons_per_lx_s", instead);
  }

  void operator()(std::monostate) const {}
  void operator()(const spec::Channels& channels) const {
    for (const auto& named : channels.value) {
      context.coverage.channel = named.name;
      if (detector)
        if (auto channel = build_channel(named, *detector, context))
          sensor.channels.push_back(*std::move(channel));
    }
    context.coverage.channel.clear();
  }
  void operator()(const spec::MeasuredCamera& camera) const {
    refuse(sensor_spec.quantum_efficiency, "quantum_efficiency", "camera");
    const auto name = context.table(camera.value, camera.where);
    if (name && detector)
      sensor.channels =
          load_camera(*name, camera.where, context.diagnostics, detector->response, detector->scale)
              .value_or(std::vector<Channel>{});
  }
  void operator()(const spec::StandardObserver& observer) const {
    refuse_responses("observer");
    sensor.channels = observer_channels(observer.value);
  }
  void operator()(const spec::Bins& bins) const {
    refuse_responses("spectral");
    refuse(sensor_spec.filters, "filters", "spectral");
    refuse(sensor_spec.lens_transmission, "lens_transmission", "spectral");
    refuse(sensor_spec.polariser, "polariser", "spectral");
    refuse(sensor_spec.mosaic, "mosaic", "spectral");
    sensor.spectral = build_bins(bins, context);
    if (sensor.spectral) sensor.channels = spectral_channels(*sensor.spectral);
  }
};

// Converts the channels to electron counts if the peak quantum efficiency or the daylight sensitivity is
// given. For the latter the scale is arbitrary here and is set later, once the filters are known.
void scale_to_peak(const spec::Sensor& spec, Sensor& sensor, LoadContext& context) {
  const auto& counted = spec.electrons_per_lx_s;
  const auto& peak = spec.peak_quantum_efficiency ? spec.peak_quantum_efficiency : counted;
  if (!peak) return;
  const char* const key = &peak == &counted ? "electrons_per_lx_s" : "peak_quantum_efficiency";
  if (spec.peak_quantum_efficiency && counted)
    context.diagnostics.error(counted->where,
                              "sets the same scale as peak_quantum_efficiency: give only one of them");
  else if (spec.quantum_efficiency)
    context.diagnostics.error(peak->where, fmt::format("{} cannot be combined with quantum_efficiency", key));
  else if (!sensor.channels.empty() && !sensor.spectral && !standard_observer(sensor.channels))
    sensor.channels = with_peak_efficiency(std::move(sensor.channels), peak->value);
}

// Position at which a channel is declared: its own name, or the key that declares all channels.
const SourcePosition& where_of_channel(const Channel& channel, const spec::Sensor& spec) {
  if (const auto* channels = std::get_if<spec::Channels>(&spec.counts))
    for (const auto& named : channels->value)
      if (named.name == channel.name) return named.where;
  return std::visit(
      [&](const auto& counts) -> const SourcePosition& {
        if constexpr (requires { counts.where; })
          return counts.where;
        else
          return spec.where;
      },
      spec.counts);
}

// Sets the channels, behind all filters, or the wavelength bins.
void build_filtered(const spec::Sensor& spec, Sensor& sensor, LoadContext& context) {
  const std::optional<Detector> detector = build_detector(spec, context);
  std::visit(ChannelBuilder{spec, detector, sensor, context}, spec.counts);
  scale_to_peak(spec, sensor, context);
  for (Channel& channel : sensor.channels) {
    if (detector && detector->filters) channel = behind(std::move(channel), *detector->filters);
    if (detector && detector->polariser && !channel.analyser)
      channel = behind(std::move(channel), *detector->polariser);
    limit_angles(channel, 0);
    if (envelope(channel).max() == 0 && envelope(channel).min() == 0)
      context.diagnostics.error(where_of_channel(channel, spec),
                                fmt::format("channel \"{}\" responds to no wavelength in [{}, {}] nm",
                                            channel.name, kMinWavelengthNm, kMaxWavelengthNm));
  }
}

// Reports settings that exclude the measurement of all Stokes components.
void check_stokes(const spec::Sensor& spec, const Sensor& sensor, LoadContext& context) {
  const auto refuse_with = [&](bool present, const char* what) {
    if (present)
      context.diagnostics.error(spec.stokes->where, fmt::format("stokes cannot be combined with {}", what));
  };
  refuse_with(any_analyser(sensor.channels), "polarisers, behind which a channel measures one component");
  refuse_with(spec.mosaic.has_value(), "a mosaic, whose pixels record one value each");
  refuse_with(spec.readout.has_value(), "a readout, because Stokes components may be negative");
}

}  // namespace

std::optional<SpectralBins> build_bins(const spec::Bins& spec, LoadContext& context) {
  const double bins = (spec.to_nm - spec.from_nm) / spec.step_nm;
  if (bins > kMinBins - 0.5 && bins < kMaxBins + 0.5 && std::abs(bins - std::round(bins)) < 1e-6)
    return SpectralBins{spec.from_nm, spec.step_nm, static_cast<int>(std::round(bins))};
  return context.refuse(
      spec.where,
      fmt::format("the bins do not fill the range (got {} of {} nm in [{}, {}] nm, allowed {} to {})", bins,
                  spec.step_nm, spec.from_nm, spec.to_nm, kMinBins, kMaxBins));
}

void build_channels(const spec::Sensor& spec, Sensor& sensor, LoadContext& context) {
  std::vector<PartialTable> partial_tables;
  context.coverage.partial_tables = &partial_tables;
  build_filtered(spec, sensor, context);
  context.coverage.partial_tables = nullptr;
  // Tables may end within the range in which the other factors of a channel are not negligible.
  if (!partial_tables.empty()) {
    Diagnostics discarded;
    LoadContext extrapolating = extrapolating_context(context, discarded);
    Sensor extrapolated;
    build_filtered(spec, extrapolated, extrapolating);
    check_table_range(partial_tables, Curve(1.0), extrapolated.channels, context);
  }
  if (!spec.stokes || !spec.stokes->value) return;
  check_stokes(spec, sensor, context);
  if (!any_analyser(sensor.channels) && !spec.mosaic)
    sensor.channels = with_stokes(std::move(sensor.channels));
}

}  // namespace abbe::description

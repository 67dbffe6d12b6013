#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "description/sensor.h"
#include "description/table_ends.h"
#include "sensor/response/stokes_channels.h"

namespace abbe::description {
namespace {

constexpr Range kExtinctionRatio{1, 1e9};

// As EXR files can name channels and what is said of them.
constexpr std::size_t kLongestName = 100;

constexpr int kFewestBins = 2;  // the files tell widths by the distances of centres
constexpr int kMostBins = 1000;

// Channels name the planes of an EXR, whose layers are separated by dots.
bool is_plain(std::string_view name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kLongestName && std::all_of(name.begin(), name.end(), plain);
}

/// What all channels of a sensor share.
struct Detector {
  std::optional<ResponseKind> response = {};
  ResponseScale scale = ResponseScale::absolute;
  std::optional<Curve> quantum_efficiency = {};
  std::optional<FilterStack> filters = {};  ///< Before all channels: the lens, and what lies over the sensor.
  std::optional<Polariser> polariser = {};  ///< Likewise.
  double exposure_s = 1;
};

// Puts one more filter into the stack: a curve, or one that shifts with the angle.
bool add_filter(const spec::Filter& filter, FilterStack& stack, LoadContext& context) {
  if (const auto* fixed = std::get_if<spec::Curve>(&filter)) {
    const auto curve = build(*fixed, kTransmittanceUse, context);
    if (curve) stack.fixed = product(stack.fixed, *curve);
    return curve.has_value();
  }
  const auto& shifting = std::get<spec::InterferenceFilter>(filter);
  auto curve = build(shifting.transmittance, kTransmittanceUse, context);
  if (!curve) return false;
  stack.shifting.push_back({*std::move(curve), shifting.effective_index});
  return true;
}

std::optional<FilterStack> build_filters(const spec::Filters& filters, LoadContext& context) {
  FilterStack stack;
  bool complete = true;
  for (const spec::Filter& filter : filters) complete = add_filter(filter, stack, context) && complete;
  return complete ? std::optional(std::move(stack)) : std::nullopt;
}

std::optional<Polariser> build_polariser(const spec::PolarisingFilter& said, LoadContext& context) {
  Polariser polariser{said.angle_deg};
  const auto& passing = said.transmittance;
  const auto transmittance = passing ? build(*passing, kTransmittanceUse, context) : Curve(1.0);
  const auto& ratio = said.extinction_ratio;
  if (ratio) polariser.extinction_ratio = build(*ratio, {"filter", kExtinctionRatio}, context);
  if (!transmittance || (ratio && !polariser.extinction_ratio)) return std::nullopt;
  polariser.transmittance = *transmittance;
  return polariser;
}

// Nothing after an error.
std::optional<Detector> build_detector(const spec::Sensor& said, LoadContext& context) {
  Detector detector{.exposure_s = said.exposure_s};
  if (said.response) detector.response = said.response->value;
  if (said.peak_quantum_efficiency || said.electrons_per_lx_s) detector.scale = ResponseScale::relative;
  const auto& efficiency = said.quantum_efficiency;
  if (efficiency && detector.response == ResponseKind::energy)
    context.diagnostics.error(efficiency->where,
                              "a quantum_efficiency makes the response quantum (got \"energy\")");
  if (efficiency) detector.quantum_efficiency = build(*efficiency, kQuantumEfficiencyUse, context);
  if (said.filters) detector.filters = build_filters(said.filters->value, context);
  if (said.polariser) detector.polariser = build_polariser(*said.polariser, context);
  const auto& lens = said.lens_transmission;
  const auto transmission = lens ? build(*lens, kTransmittanceUse, context) : std::optional<Curve>();
  if ((efficiency && !detector.quantum_efficiency) || (said.filters && !detector.filters) ||
      (said.polariser && !detector.polariser) || (lens && !transmission))
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
  std::optional<Polariser> polariser = {};
  double exposure_s;
};

bool is_quantum(const Detector& detector) {
  return detector.quantum_efficiency || detector.response == ResponseKind::quantum;
}

// Responses to energy have no unit that is told, nor has what is scaled afterwards. Before a detector whose
// quantum efficiency is told a response is what its filter passes.
CurveUse response_use(const Detector& detector) {
  const bool filter = detector.quantum_efficiency.has_value();
  if (is_quantum(detector) && detector.scale == ResponseScale::absolute)
    return {"filter", kQuantumResponseUse.allowed, kQuantumResponseUse.unit, filter};
  const bool unsaid = !is_quantum(detector) && !detector.response;
  return {"filter", spec::kValue, unsaid ? CurveUnit::unsaid_response : CurveUnit::any, filter};
}

// Either a curve, or filters perhaps with an exposure time.
std::optional<Own> build_own(const spec::ChannelResponse& said, const Detector& detector,
                             LoadContext& context) {
  Own own{.exposure_s = detector.exposure_s};
  if (const auto* response = std::get_if<spec::Curve>(&said)) {
    auto curve = build(*response, response_use(detector), context);
    if (!curve) return std::nullopt;
    own.curve = *std::move(curve);
    return own;
  }
  const auto& filtered = std::get<spec::FilteredChannel>(said);
  auto stack = build_filters(filtered.filters.value_or(spec::Filters{}), context);
  if (filtered.polariser) own.polariser = build_polariser(*filtered.polariser, context);
  if (!stack || (filtered.polariser && !own.polariser)) return std::nullopt;
  if (filtered.polariser && detector.polariser)
    context.diagnostics.error(filtered.polariser->where,
                              "a second polariser: the sensor has one before all channels");
  own.exposure_s = filtered.exposure_s.value_or(own.exposure_s);
  own.curve = std::exchange(stack->fixed, Curve(1.0));
  own.filters = *std::move(stack);
  return own;
}

std::optional<Channel> build_channel(const schema::Named<spec::ChannelResponse>& said,
                                     const Detector& detector, LoadContext& context) {
  const std::string& name = said.name;
  if (!is_plain(name)) {
    context.diagnostics.error(
        said.where, fmt::format("a channel's name has up to {} letters, digits, - and _ only (got \"{}\")",
                                kLongestName, name));
    return std::nullopt;
  }
  std::optional<Own> own = build_own(said.value, detector, context);
  if (!own) return std::nullopt;
  Curve& curve = own->curve;
  if (detector.quantum_efficiency) curve = product(curve, *detector.quantum_efficiency);
  Channel channel =
      is_quantum(detector) ? quantum_channel(name, curve) : energy_channel(name, std::move(curve));
  if (!own->filters.shifting.empty()) channel = behind(std::move(channel), own->filters);
  if (own->polariser) channel = behind(std::move(channel), *own->polariser);
  if (own->exposure_s != detector.exposure_s)
    channel = exposed(std::move(channel), own->exposure_s / detector.exposure_s);
  return channel;
}

// Responses that others have themselves.
void refuse(const SourcePosition* at, const char* key, const char* instead, LoadContext& context) {
  if (at != nullptr)
    context.diagnostics.error(*at,
                              fmt::format("{} goes with channels (got {}, which has its own)", key, instead));
}
template <typename T>
const SourcePosition* place(const std::optional<T>& said) {
  return said ? &said->where : nullptr;
}

/// Makes the channels of each way to say what pixels count. Those of a faulty detector are left out.
struct ChannelBuilder {
  const spec::Sensor& said;
  const std::optional<Detector>& detector;
  Sensor& sensor;
  LoadContext& context;

  void operator()(std::monostate) const {}
  void operator()(const spec::Channels& channels) const {
    for (const auto& named : channels.value) {
      context.ends.channel = named.name;
      if (detector)
        if (auto channel = build_channel(named, *detector, context))
          sensor.channels.push_back(*std::move(channel));
    }
    context.ends.channel.clear();
  }
  void operator()(const spec::MeasuredCamera& camera) const {
    refuse(place(said.quantum_efficiency), "quantum_efficiency", "camera", context);
    const auto name = context.table(camera.value, camera.where);
    if (name && detector)
      sensor.channels =
          load_camera(*name, camera.where, context.diagnostics, detector->response, detector->scale)
              .value_or(std::vector<Channel>{});
  }
  void operator()(const spec::StandardObserver& observer) const {
    refuse(place(said.response), "response", "observer", context);
    refuse(place(said.quantum_efficiency), "quantum_efficiency", "observer", context);
    refuse(place(said.peak_quantum_efficiency), "peak_quantum_efficiency", "observer", context);
    refuse(place(said.electrons_per_lx_s), "electrons_per_lx_s", "observer", context);
    sensor.channels = observer_channels(observer.value);
  }
  void operator()(const spec::Bins& bins) const {
    refuse(place(said.response), "response", "spectral", context);
    refuse(place(said.quantum_efficiency), "quantum_efficiency", "spectral", context);
    refuse(place(said.peak_quantum_efficiency), "peak_quantum_efficiency", "spectral", context);
    refuse(place(said.electrons_per_lx_s), "electrons_per_lx_s", "spectral", context);
    refuse(place(said.filters), "filters", "spectral", context);
    refuse(place(said.lens_transmission), "lens_transmission", "spectral", context);
    refuse(place(said.polariser), "polariser", "spectral", context);
    refuse(place(said.mosaic), "mosaic", "spectral", context);
    sensor.spectral = build_bins(bins, context);
    if (sensor.spectral) sensor.channels = spectral_channels(*sensor.spectral);
  }
};

// Makes counters of electrons of channels whose efficiency is told by its peak, or, for now by any, by what a
// pixel counts in daylight: behind filters of which nothing is known here.
void scale_to_peak(const spec::Sensor& said, Sensor& sensor, LoadContext& context) {
  const auto& counted = said.electrons_per_lx_s;
  const auto& peak = said.peak_quantum_efficiency ? said.peak_quantum_efficiency : counted;
  if (!peak) return;
  const char* const key = &peak == &counted ? "electrons_per_lx_s" : "peak_quantum_efficiency";
  if (said.peak_quantum_efficiency && counted)
    context.diagnostics.error(counted->where,
                              "says the scale that peak_quantum_efficiency says too; give one of them");
  else if (said.quantum_efficiency)
    context.diagnostics.error(peak->where, fmt::format("{} goes without quantum_efficiency", key));
  else if (!sensor.channels.empty() && !sensor.spectral && !standard_observer(sensor.channels))
    sensor.channels = with_peak_efficiency(std::move(sensor.channels), peak->value);
}

// Where a channel is said: by its own name, or with all others.
const SourcePosition& place_of(const Channel& channel, const spec::Sensor& said) {
  if (const auto* channels = std::get_if<spec::Channels>(&said.counts))
    for (const auto& named : channels->value)
      if (named.name == channel.name) return named.where;
  return std::visit(
      [&](const auto& counts) -> const SourcePosition& {
        if constexpr (requires { counts.where; })
          return counts.where;
        else
          return said.where;
      },
      said.counts);
}

void require_response(const Channel& channel, const SourcePosition& where, LoadContext& context) {
  if (envelope(channel).max() == 0 && envelope(channel).min() == 0)
    context.diagnostics.error(where, fmt::format("channel \"{}\" responds to no wavelength in [{}, {}] nm",
                                                 channel.name, kMinWavelengthNm, kMaxWavelengthNm));
}

// Fills in what the pixels count: the channels behind all filters, or the bins.
void build_filtered(const spec::Sensor& said, Sensor& sensor, LoadContext& context) {
  const std::optional<Detector> detector = build_detector(said, context);
  std::visit(ChannelBuilder{said, detector, sensor, context}, said.counts);
  scale_to_peak(said, sensor, context);
  for (Channel& channel : sensor.channels) {
    if (detector && detector->filters) channel = behind(std::move(channel), *detector->filters);
    if (detector && detector->polariser && !channel.analyser)
      channel = behind(std::move(channel), *detector->polariser);
    limit_angles(channel, 0);
    require_response(channel, place_of(channel, said), context);
  }
}

// The same with a word where tables of it end within what the others let count.
void build_covered(const spec::Sensor& said, Sensor& sensor, LoadContext& context) {
  std::vector<EndedTable> ended;
  context.ends.noted = &ended;
  build_filtered(said, sensor, context);
  context.ends.noted = nullptr;
  if (ended.empty()) return;
  Diagnostics unheard;
  LoadContext on = going_on(context, unheard);
  Sensor longer;
  build_filtered(said, longer, on);
  check_ends(ended, Curve(1.0), longer.channels, context);
}

// What stands in the way of measuring all of the light's polarisation.
void check_stokes(const spec::Sensor& said, const Sensor& sensor, LoadContext& context) {
  const auto refuse_beside = [&](bool there, const char* what) {
    if (there) context.diagnostics.error(said.stokes->where, fmt::format("stokes goes without {}", what));
  };
  refuse_beside(any_analyser(sensor.channels), "polarisers, whose channels measure a part of it");
  refuse_beside(said.mosaic.has_value(), "a mosaic, whose pixels count one value each");
  refuse_beside(said.readout.has_value(), "a read-out, as its planes have a sign");
}

}  // namespace

std::optional<SpectralBins> build_bins(const spec::Bins& said, LoadContext& context) {
  const double bins = (said.to_nm - said.from_nm) / said.step_nm;
  if (bins > kFewestBins - 0.5 && bins < kMostBins + 0.5 && std::abs(bins - std::round(bins)) < 1e-6)
    return SpectralBins{said.from_nm, said.step_nm, static_cast<int>(std::round(bins))};
  context.diagnostics.error(
      said.where,
      fmt::format("the bins do not fill the range (got {} of {} nm in [{}, {}] nm, allowed {} to {})", bins,
                  said.step_nm, said.from_nm, said.to_nm, kFewestBins, kMostBins));
  return std::nullopt;
}

void build_channels(const spec::Sensor& said, Sensor& sensor, LoadContext& context) {
  build_covered(said, sensor, context);
  if (!said.stokes || !said.stokes->value) return;
  check_stokes(said, sensor, context);
  if (!any_analyser(sensor.channels) && !said.mosaic)
    sensor.channels = with_stokes(std::move(sensor.channels));
}

}  // namespace abbe::description

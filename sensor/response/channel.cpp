#include "sensor/response/channel.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "io/json.h"
#include "io/json_values.h"
#include "io/table.h"
#include "io/text.h"
#include "sensor/response/table_range.h"
#include "spectral/curve_use.h"
#include "spectral/sources.h"

namespace abbe {

namespace {
// Largest value on the open interval (low, high), where the curve is linear between its knots.
double largest_between(const Curve& curve, double low, double high) {
  const auto knots = curve.knots();
  const auto after = [](double nm, const Knot& knot) { return nm < knot.wavelength_nm; };
  auto knot = std::upper_bound(knots.begin(), knots.end(), low, after);
  double largest = curve(low);  // value to the right of a jump at low
  for (; knot != knots.end() && knot->wavelength_nm < high; ++knot) largest = std::max(largest, knot->value);
  return std::max(largest, curve(std::nextafter(high, low)));
}

// Applies a function to the values of a curve: exact at its knots and at every nanometre.
template <typename Function>
Curve of_each(const Curve& curve, Function function) {
  std::vector<Knot> knots;
  for (const Knot& knot : curve.knots()) {
    if (!knots.empty())
      for (double nm = std::floor(knots.back().wavelength_nm) + 1; nm < knot.wavelength_nm; ++nm)
        knots.push_back({nm, curve(nm)});
    knots.push_back(knot);
  }
  for (Knot& knot : knots) knot.value = function(knot.value);
  return Curve(std::move(knots));
}

// Photons per joule: lambda/(hc).
Curve photons_per_joule() {
  return Curve({{kMinWavelengthNm, 1 / photon_energy(kMinWavelengthNm)},
                {kMaxWavelengthNm, 1 / photon_energy(kMaxWavelengthNm)}});
}

bool is_json(const std::string& name) {
  return name.ends_with(".json");
}

// All columns of a camera's table, or the one in `name`, named by their channels.
std::optional<std::vector<NamedCurve>> camera_curves(const std::string& name, const SourcePosition& where,
                                                     Diagnostics& diagnostics) {
  if (is_json(name)) return read_camera_json(name, diagnostics);
  const std::optional<TableColumn> location = find_table("camera", name, where, diagnostics);
  if (!location) return std::nullopt;
  std::vector<std::string> labels{location->column};
  if (location->column.empty()) {
    const bool shipped = user_table_end(name) == std::string::npos;
    const std::optional<Table> table =
        read_table(location->path, shipped ? TableOrigin::shipped : TableOrigin::user, diagnostics);
    if (!table) return std::nullopt;
    labels.assign(table->columns.begin() + 1, table->columns.end());
    std::erase_if(labels, [](const std::string& label) { return label.starts_with("wavelength_"); });
    if (labels.empty()) diagnostics.error(table->where, "has no channel column", ErrorCode::input);
    if (labels.empty()) return std::nullopt;
  }
  std::vector<NamedCurve> curves;
  for (const std::string& label : labels) {
    const std::string column = location->column.empty() ? name + ":" + label : name;
    std::optional<NamedCurve> curve = load_curve("camera", column, where, diagnostics);
    if (!curve) return std::nullopt;
    curve->name = label;
    curves.push_back(*std::move(curve));
  }
  return curves;
}

// Checks that a table without an extrapolation rule covers the response. A table that declares 0 needs no
// check.
bool check_response_range(const NamedCurve& curve, const std::string& column, const Channel& channel,
                          const SourcePosition& where, Diagnostics& diagnostics) {
  if (curve.outside != Outside::error) return true;
  NamedCurve named = curve;
  named.name = column;
  return check_table_range(named, Curve(1.0), named_responses({&channel, 1}), where, diagnostics);
}

ResponseKind photometric_kind(Observer observer) {
  return observer == Observer::cie1931 ? ResponseKind::photometric : ResponseKind::photometric_1964;
}

constexpr const char* kUnit = "relative";

// Member at the end of a path of keys. Reports a missing key.
const JsonValue* descend(const JsonValue& root, std::initializer_list<const char*> keys,
                         Diagnostics& diagnostics) {
  const JsonValue* value = &root;
  for (const char* key : keys) {
    const JsonValue* const inner = value->find(key);
    if (inner == nullptr) {
      diagnostics.error(value->where, fmt::format("missing key \"{}\"", key), ErrorCode::input);
      return nullptr;
    }
    value = inner;
  }
  return value;
}

std::vector<std::string> channel_names(const JsonValue& main, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  if (const auto* const list = std::get_if<JsonValue::Array>(&main.value))
    for (const JsonValue& name : *list) names.push_back(read_string(name, diagnostics).value_or(""));
  if (names.empty()) diagnostics.error(main.where, "expected the names of the channels", ErrorCode::input);
  return names;
}

struct CameraSamples {
  std::vector<double> wavelengths_nm;
  std::vector<std::vector<double>> values;  // one list per channel
};

CameraSamples samples_of(const JsonValue& main, std::size_t channels, Diagnostics& diagnostics) {
  CameraSamples samples{{}, std::vector<std::vector<double>>(channels)};
  const auto* const rows = std::get_if<JsonValue::Object>(&main.value);
  if (rows == nullptr || rows->size() < 2) {
    diagnostics.error(main.where, "expected two wavelengths or more, each with its values", ErrorCode::input);
    return samples;
  }
  for (const auto& [key, row] : *rows) {
    const double nm = parse_number(key).value_or(0);
    const double last = samples.wavelengths_nm.empty() ? 0 : samples.wavelengths_nm.back();
    if (!(nm >= kMinWavelengthNm && nm <= kMaxWavelengthNm && nm > last))
      diagnostics.error(row.key_position(),
                        fmt::format("got wavelength {}, allowed ascending numbers of nm in [{}, {}]", key,
                                    kMinWavelengthNm, kMaxWavelengthNm),
                        ErrorCode::input);
    samples.wavelengths_nm.push_back(nm);
    const auto values = read_numbers(row, channels, Range::any(), diagnostics);
    for (std::size_t k = 0; values && k < channels; ++k) samples.values[k].push_back((*values)[k]);
  }
  return samples;
}

// Transmittance at an angle of incidence: T(lambda / blue_shift).
Curve shifted(const InterferenceFilter& filter, double cos_film) {
  const double shift = blue_shift(cos_film, filter.effective_index);
  std::vector<Knot> knots(filter.transmittance.knots().begin(), filter.transmittance.knots().end());
  for (Knot& knot : knots) knot.wavelength_nm *= shift;
  return Curve(std::move(knots));
}

// Transmittance of all filters at an angle of incidence.
Curve shifted(const std::vector<InterferenceFilter>& filters, double cos_film) {
  Curve all = shifted(filters.front(), cos_film);
  for (std::size_t i = 1; i < filters.size(); ++i) all = product(all, shifted(filters[i], cos_film));
  return all;
}

// Mean transmittance over the angles. Adds by recursive halving, so that few knots are copied often.
Curve mean_transmittance(const std::vector<InterferenceFilter>& filters, std::span<const Incidence> angles) {
  if (angles.size() == 1) return scaled(shifted(filters, angles.front().cos_film), angles.front().fraction);
  const std::size_t half = angles.size() / 2;
  return sum(mean_transmittance(filters, angles.first(half)),
             mean_transmittance(filters, angles.subspan(half)));
}
}  // namespace

Curve envelope(const InterferenceFilter& filter, double min_cosine) {
  const double shift = blue_shift(min_cosine, filter.effective_index);
  std::vector<double> edges;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) edges.push_back(nm);
  for (const Knot& knot : filter.transmittance.knots())
    for (const double nm : {knot.wavelength_nm, knot.wavelength_nm * shift})
      if (nm > kMinWavelengthNm && nm < kMaxWavelengthNm) edges.push_back(nm);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Knot> steps;
  steps.reserve(2 * edges.size());
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double value = largest_between(filter.transmittance, edges[i], edges[i + 1] / shift);
    steps.push_back({edges[i], value});
    steps.push_back({edges[i + 1], value});
  }
  return Curve(std::move(steps));
}

StokesSpectrum row_of(const Analyser& analyser, const SampledSpectrum& wavelengths_nm) {
  const SampledSpectrum contrast = analyser.contrast(wavelengths_nm);
  return {SampledSpectrum(analyser.i), contrast * analyser.q, contrast * analyser.u, contrast * analyser.v};
}

Curve mean_transmittance(const Polariser& polariser) {
  if (!polariser.extinction_ratio) return scaled(polariser.transmittance, 0.5);
  return product(polariser.transmittance,
                 of_each(*polariser.extinction_ratio, [](double ratio) { return (1 + 1 / ratio) / 2; }));
}

Analyser analyser_of(const Polariser& polariser) {
  const double twice = polariser.angle_deg * std::numbers::pi / 90;
  Analyser analyser{1, static_cast<float>(std::cos(twice)), static_cast<float>(std::sin(twice)), 0};
  if (polariser.extinction_ratio)
    analyser.contrast =
        of_each(*polariser.extinction_ratio, [](double ratio) { return (ratio - 1) / (ratio + 1); });
  return analyser;
}

Channel energy_channel(std::string name, Curve response) {
  return {std::move(name), ResponseKind::energy, std::move(response)};
}

Channel quantum_channel(std::string name, const Curve& response) {
  return {std::move(name), ResponseKind::quantum, product(response, photons_per_joule())};
}

Channel behind(Channel channel, const FilterStack& filters) {
  channel.weight = product(channel.weight, filters.fixed);
  if (channel.angular)
    channel.angular->filters.fixed = product(channel.angular->filters.fixed, filters.fixed);
  if (filters.shifting.empty()) return channel;
  if (!channel.angular) channel.angular = AngularResponse{{channel.weight}, {}};
  for (const InterferenceFilter& filter : filters.shifting) {
    channel.weight = product(channel.weight, filter.transmittance);
    channel.angular->filters.shifting.push_back(filter);
  }
  return channel;
}

Channel behind(Channel channel, const Polariser& polariser) {
  channel = behind(std::move(channel), FilterStack{mean_transmittance(polariser)});
  channel.analyser = analyser_of(polariser);
  return channel;
}

Channel scaled(Channel channel, double factor) {
  channel.weight = scaled(channel.weight, factor);
  if (channel.angular) {
    channel.angular->filters.fixed = scaled(channel.angular->filters.fixed, factor);
    channel.angular->envelope = scaled(channel.angular->envelope, factor);
  }
  return channel;
}

Channel exposed(Channel channel, double ratio) {
  channel.exposure_ratio *= ratio;
  return scaled(std::move(channel), ratio);
}

std::vector<Channel> with_peak_efficiency(std::vector<Channel> channels, double peak) {
  // A weight is linear between its knots, so weight/lambda is largest at a knot.
  double highest = 0;
  for (const Channel& channel : channels)
    for (const Knot& knot : channel.weight.knots())
      highest = std::max(highest, knot.value / (channel.exposure_ratio * knot.wavelength_nm));
  if (!(highest > 0)) throw Error(ErrorCode::input, "camera", "responds to no wavelength");
  const double factor = peak / (photon_energy(1) * highest);  // since weight = QE lambda/(hc)
  for (Channel& channel : channels) {
    channel.kind = ResponseKind::quantum;
    channel = scaled(std::move(channel), factor);
  }
  return channels;
}

void limit_angles(Channel& channel, double min_cosine) {
  if (!channel.angular) return;
  AngularResponse& angular = *channel.angular;
  angular.envelope = angular.filters.fixed;
  for (const InterferenceFilter& filter : angular.filters.shifting)
    angular.envelope = product(angular.envelope, envelope(filter, min_cosine));
}

std::optional<std::vector<Channel>> load_camera(const std::string& name, const SourcePosition& where,
                                                Diagnostics& diagnostics, std::optional<ResponseKind> kind,
                                                ResponseScale scale) {
  const auto curves = camera_curves(name, where, diagnostics);
  if (!curves) return std::nullopt;
  std::vector<Channel> channels;
  for (const NamedCurve& curve : *curves) {
    const std::string& label = curve.name;
    const bool quantum = kind ? *kind == ResponseKind::quantum : label == "QE" && !is_json(name);
    const std::string column = name.ends_with(":" + label) ? name : name + ":" + label;
    if (quantum && scale == ResponseScale::absolute &&
        !check_use(column, curve.unit, curve.curve, kQuantumResponseUse, where, diagnostics))
      return std::nullopt;
    if (!kind && !quantum && channels.empty())
      if (auto doubt = unknown_response(name, curve.unit))
        diagnostics.error_if_strict(where, *std::move(doubt));
    channels.push_back(quantum ? quantum_channel(label, curve.curve) : energy_channel(label, curve.curve));
    if (!check_response_range(curve, column, channels.back(), where, diagnostics)) return std::nullopt;
  }
  return channels;
}

std::vector<Channel> observer_channels(Observer observer) {
  const ColorMatching& cmf = color_matching(observer);
  const ResponseKind kind = photometric_kind(observer);
  return {{"X", kind, scaled(cmf.x, kLuminousEfficacy)},
          {"Y", kind, scaled(cmf.y, kLuminousEfficacy)},
          {"Z", kind, scaled(cmf.z, kLuminousEfficacy)}};
}

std::optional<Observer> standard_observer(std::span<const Channel> channels) {
  if (channels.size() != 3 || channels[0].name != "X" || channels[1].name != "Y" || channels[2].name != "Z")
    return std::nullopt;
  for (const Observer observer : {Observer::cie1931, Observer::cie1964})
    if (std::ranges::count(channels, photometric_kind(observer), &Channel::kind) == 3) return observer;
  return std::nullopt;
}

std::optional<std::vector<NamedCurve>> read_camera_json(const std::filesystem::path& path,
                                                        Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.all().size();
  const auto source = read_text(path, diagnostics);
  if (!source) return std::nullopt;
  const std::optional<JsonValue> root = parse_json(source, diagnostics);
  if (!root) return std::nullopt;
  const JsonValue* const units = descend(*root, {"spectral_data", "units"}, diagnostics);
  const JsonValue* const index = descend(*root, {"spectral_data", "index", "main"}, diagnostics);
  const JsonValue* const data = descend(*root, {"spectral_data", "data", "main"}, diagnostics);
  if (units == nullptr || index == nullptr || data == nullptr) return std::nullopt;
  static_cast<void>(read_choice(*units, "unit", std::array{kUnit}, diagnostics));
  const std::vector<std::string> names = channel_names(*index, diagnostics);
  const CameraSamples samples = samples_of(*data, names.size(), diagnostics);
  if (diagnostics.all().size() != before) return std::nullopt;
  const std::vector<double>& nm = samples.wavelengths_nm;
  std::vector<NamedCurve> curves;
  for (std::size_t k = 0; k < names.size(); ++k)
    curves.push_back({names[k], path.string(), kUnit, nm.front(), nm.back(),
                      table_curve(nm, samples.values[k], Outside::zero)});
  return curves;
}

Channel averaged(Channel channel, std::span<const Incidence> angles) {
  if (!channel.angular) return channel;
  const FilterStack& filters = channel.angular->filters;
  channel.weight = product(filters.fixed, mean_transmittance(filters.shifting, angles));
  channel.angular.reset();
  return channel;
}

bool any_angular(std::span<const Channel> channels) {
  return std::ranges::any_of(channels, [](const Channel& c) { return c.angular.has_value(); });
}

}  // namespace abbe

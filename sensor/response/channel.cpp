#include "sensor/response/channel.h"

#include <algorithm>
#include <utility>

#include "io/error.h"
#include "io/table.h"
#include "sensor/response/camera_json.h"
#include "sensor/response/table_range.h"
#include "spectral/curve_use.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

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
  if (!location->column.empty()) {
    std::optional<NamedCurve> curve = load_curve("camera", name, where, diagnostics);
    if (!curve) return std::nullopt;
    curve->name = location->column;
    return std::vector{*std::move(curve)};
  }
  const bool shipped = user_table_end(name) == std::string::npos;
  const std::optional<Table> table =
      read_table(location->path, shipped ? TableOrigin::shipped : TableOrigin::user, diagnostics);
  if (!table) return std::nullopt;
  std::vector<NamedCurve> curves;
  for (std::size_t column = 1; column < table->columns.size(); ++column) {
    const std::string& label = table->columns[column];
    if (label.starts_with("wavelength_")) continue;
    std::optional<NamedCurve> curve = load_curve("camera", name + ":" + label, where, diagnostics);
    if (!curve) return std::nullopt;
    curve->name = label;
    curves.push_back(*std::move(curve));
  }
  if (!curves.empty()) return curves;
  diagnostics.error(table->where, "has no channel column", ErrorCode::input);
  return std::nullopt;
}

// Checks that a table without an extrapolation rule covers the response. A table that declares 0 needs no
// check.
bool check_response_range(const NamedCurve& curve, const std::string& column, const Channel& channel,
                          const SourcePosition& where, Diagnostics& diagnostics) {
  if (curve.outside != Outside::error) return true;
  NamedCurve named = curve;
  named.name = column;
  return check_table_range(named, Curve(1.0), {&channel, 1}, where, diagnostics);
}

ResponseKind photometric_kind(Observer observer) {
  return observer == Observer::cie1931 ? ResponseKind::photometric : ResponseKind::photometric_1964;
}

}  // namespace

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

}  // namespace abbe

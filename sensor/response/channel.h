#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "sensor/response/analyser.h"
#include "sensor/response/filter.h"
#include "spectral/colorimetry.h"
#include "spectral/curve.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// Quantity that a response multiplies: the incident energy, the incident photons, or the luminous exposure
/// for the colour-matching functions of 1931. `photometric_1964` is the corresponding integral with those of
/// 1964.
enum class ResponseKind { energy, quantum, photometric, photometric_1964 };

/// Dependence of the weight of a channel on the angle of incidence.
struct AngularResponse {
  FilterStack filters;  ///< `fixed` is the part of the weight that does not depend on the angle.
  Curve envelope;       ///< Curve whose magnitude bounds that of the weight over all angles that occur.
};

/// One channel of a sensor. Its film value for a spectral irradiance E over the exposure time t of the sensor
/// is t * integral of E(lambda) weight(lambda). The weight includes lambda/(hc) for a quantum channel and
/// 683.002 lm/W for an observer. The unit is J/m^2 weighted by the response for an energy channel, electrons
/// per m^2 for a quantum channel, and lx s for a channel of the 1931 observer.
struct Channel {
  std::string name;
  ResponseKind kind = ResponseKind::energy;
  Curve weight;               ///< Weight for unpolarised light along the normal of its filters.
  double exposure_ratio = 1;  ///< Own exposure time over that of the sensor; included in the weight.
  std::optional<AngularResponse> angular = {};  ///< Present if a filter shifts with the angle.
  /// Present if the channel depends on polarisation; its result multiplies the weight.
  std::optional<Analyser> analyser = {};
};

/// Weight for unpolarised light at several wavelengths [nm], whose angle of incidence on the film has this
/// cosine.
[[nodiscard]] inline SampledSpectrum weight_at(const Channel& channel, const SampledSpectrum& wavelengths_nm,
                                               float cos_film) {
  if (!channel.angular) return channel.weight(wavelengths_nm);
  SampledSpectrum weight = channel.angular->filters.fixed(wavelengths_nm);
  for (const InterferenceFilter& filter : channel.angular->filters.shifting)
    weight *= filter.transmittance(wavelengths_nm *
                                   (1 / blue_shift(cos_film, static_cast<float>(filter.effective_index))));
  return weight;
}

/// Curve whose magnitude bounds that of the weight over all angles that occur, for sampling lights and
/// wavelengths. It may be negative where the weight is.
[[nodiscard]] inline const Curve& envelope(const Channel& channel) {
  return channel.angular ? channel.angular->envelope : channel.weight;
}

/// A channel whose response multiplies energy: weight = response.
[[nodiscard]] Channel energy_channel(std::string name, Curve response);

/// A channel whose response (quantum efficiency times filters, electrons per photon) multiplies photons:
/// weight = response lambda/(hc).
[[nodiscard]] Channel quantum_channel(std::string name, const Curve& response);

/// The channel behind filters that receive light at all angles. A stack with shifting filters leaves
/// `angular->envelope` invalid: `limit_angles` must follow.
[[nodiscard]] Channel behind(Channel channel, const FilterStack& filters);
/// The channel behind a polariser: `mean_transmittance` multiplies its weight. It must not have an analyser
/// yet.
[[nodiscard]] Channel behind(Channel channel, const Polariser& polariser);
/// The channel with its weight multiplied by `factor`.
[[nodiscard]] Channel scaled(Channel channel, double factor);
/// The channel with its exposure time multiplied by `ratio`, which also multiplies its weight.
[[nodiscard]] Channel exposed(Channel channel, double ratio);
/// Channels that count electrons, scaled by a common factor so that their largest quantum efficiency is
/// `peak`. Responses to energy S become efficiencies proportional to S(lambda)/lambda; responses to photons
/// keep their shape. Throws Error{input} if no channel responds at any wavelength.
[[nodiscard]] std::vector<Channel> with_peak_efficiency(std::vector<Channel> channels, double peak);
/// Sets the channel's envelope for angles of incidence whose cosine is at least `min_cosine`. No effect on a
/// channel without shifting filters.
void limit_angles(Channel& channel, double min_cosine);

/// Scale of quantum efficiencies. `absolute`: their values count; `relative`: only their ratios.
enum class ResponseScale { absolute, relative };

/// Channels of a measured camera or detector: one per column of a table of `data/camera`, of a user's table
/// or of a `.json` file (`read_camera_json`). Without `kind`, columns named QE are quantum efficiencies. All
/// others are responses to energy ("to be multiplied by spectral power"); a unit that mentions photons then
/// causes a warning, or an error if strict. Every `kind` but `quantum` gives energy channels. Reports errors
/// and returns nothing for all errors of `load_curve` or `read_camera_json`, and for
/// - absolute quantum efficiencies in percent or outside `kQuantumResponseUse`;
/// - a table without an extrapolation rule, if constant extrapolation puts a non-negligible part of the
///   response outside it.
[[nodiscard]] std::optional<std::vector<Channel>> load_camera(const std::string& name,
                                                              const SourcePosition& where,
                                                              Diagnostics& diagnostics,
                                                              std::optional<ResponseKind> kind = {},
                                                              ResponseScale scale = ResponseScale::absolute);

/// Standard observer as a sensor: X, Y, Z with weights of 683.002 times the colour-matching functions. Y of
/// 1931 is in lx s.
[[nodiscard]] std::vector<Channel> observer_channels(Observer observer);
/// Observer of three channels made by `observer_channels`, possibly behind filters. Nothing for other
/// channels of the same names.
[[nodiscard]] std::optional<Observer> standard_observer(std::span<const Channel> channels);

}  // namespace abbe

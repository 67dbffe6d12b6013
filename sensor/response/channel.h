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
#include "spectral/packet.h"

namespace abbe {

/// What a response multiplies: the energy that arrives, the photons that arrive, or, of the colour-matching
/// functions of the observer of 1931, the luminous exposure, and of that of 1964 what is like it.
enum class ResponseKind { energy, quantum, photometric, photometric_1964 };

/// How the weight of a channel depends on the angle of incidence.
struct AngularResponse {
  FilterStack filters;  ///< Of which `fixed` is all of the weight that does not depend on the angle.
  Curve envelope;       ///< Nowhere less than the weight at any angle that occurs.
};

/// One channel of a sensor. Its film value for a spectral irradiance E over the sensor's exposure t is t
/// times the integral of E(lambda) weight(lambda): J/m^2 weighted by the response for an energy channel,
/// electrons per m^2 for a quantum channel, lx s for one of the observer of 1931.
struct Channel {
  std::string name;
  ResponseKind kind = ResponseKind::energy;
  Curve weight;               ///< For unpolarised light along the normal of its filters.
  double exposure_ratio = 1;  ///< Of its own exposure time to the sensor's; the weight contains it.
  std::optional<AngularResponse> angular = {};  ///< When some filter of it shifts with the angle.
  /// When it tells polarised light from unpolarised light; what it measures is then times the weight.
  std::optional<Analyser> analyser = {};
};

/// The weight for light that arrives under an angle of this cosine.
[[nodiscard]] inline SampledSpectrum weight_at(const Channel& channel, const SampledSpectrum& wavelengths_nm,
                                               float cos_film) {
  if (!channel.angular) return channel.weight(wavelengths_nm);
  SampledSpectrum weight = channel.angular->filters.fixed(wavelengths_nm);
  for (const InterferenceFilter& filter : channel.angular->filters.shifting)
    weight *= filter.transmittance(wavelengths_nm *
                                   (1 / blue_shift(cos_film, static_cast<float>(filter.effective_index))));
  return weight;
}

/// Nowhere less in magnitude than the weight at any angle that occurs: by it lights and wavelengths are
/// drawn.
[[nodiscard]] inline const Curve& envelope(const Channel& channel) {
  return channel.angular ? channel.angular->envelope : channel.weight;
}

/// A channel whose response multiplies energy.
[[nodiscard]] Channel energy_channel(std::string name, Curve response);

/// A channel whose response (quantum efficiency times filters, electrons per photon) multiplies photons:
/// weight = response lambda/(hc).
[[nodiscard]] Channel quantum_channel(std::string name, const Curve& response);

/// The channel behind filters, reached by light from all sides.
[[nodiscard]] Channel behind(Channel channel, const FilterStack& filters);
/// The channel, which has no analyser yet, behind a polariser.
[[nodiscard]] Channel behind(Channel channel, const Polariser& polariser);
/// The channel that counts `factor` times as much of the same light.
[[nodiscard]] Channel scaled(Channel channel, double factor);
/// The channel with an exposure of its own, `ratio` times the sensor's.
[[nodiscard]] Channel exposed(Channel channel, double ratio);
/// The channels as counters of electrons, scaled by one factor so that the greatest quantum efficiency among
/// them and over all wavelengths is `peak`. Responses to energy S become efficiencies proportional to
/// S(lambda)/lambda, those to photons keep their shape. Throws Error{input} when none responds anywhere.
[[nodiscard]] std::vector<Channel> with_peak_efficiency(std::vector<Channel> channels, double peak);
/// Tells the channel that the cosines of the angles of incidence are at least this.
void limit_angles(Channel& channel, double least_cosine);

/// Whether the numbers of quantum efficiencies count, or only how they compare.
enum class ResponseScale { absolute, relative };

/// The channels of a measured camera or detector in `data/camera`, one per column (R, G, B or QE), or of a
/// user's table or `.json` (see `read_camera_json`). Without a `kind`, colour cameras are energy responses
/// ("to be multiplied by spectral power"), as they are tabulated, and columns named QE quantum efficiencies;
/// others whose unit speaks of photons are warned of. Reports absolute quantum efficiencies in percent, or
/// beyond `kQuantumResponseUse`, and a table that does not say what holds beyond its rows where a share of
/// the response that is not negligible would lie there if it went on as it ends.
[[nodiscard]] std::optional<std::vector<Channel>> load_camera(const std::string& name,
                                                              const SourcePosition& where,
                                                              Diagnostics& diagnostics,
                                                              std::optional<ResponseKind> kind = {},
                                                              ResponseScale scale = ResponseScale::absolute);

/// The standard observer as a sensor: X, Y, Z with weight 683.002 times the colour-matching functions, so
/// that of 1931 Y is in lx s.
[[nodiscard]] std::vector<Channel> observer_channels(Observer observer);
/// The observer whose three channels those are, perhaps behind filters; nothing for a sensor's own of the
/// same names.
[[nodiscard]] std::optional<Observer> standard_observer(std::span<const Channel> channels);

}  // namespace abbe

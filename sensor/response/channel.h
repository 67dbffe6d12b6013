#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "spectral/colorimetry.h"
#include "spectral/curve.h"
#include "spectral/library.h"
#include "spectral/sampled_spectrum.h"
#include "spectral/stokes.h"

namespace abbe {

/// Scale of an interference filter's spectrum for light at an angle theta to its normal in air:
/// lambda(theta)/lambda_0 = sqrt(1 - sin^2 theta / n_eff^2) [Smith2008, ch. 11]. `effective_index` >= 1 lies
/// between the indices of its layers. The result is 1 along the normal and smaller at an angle.
template <typename S>
[[nodiscard]] S blue_shift(S cos_theta, S effective_index) {
  const S sine2 = (1 - cos_theta) * (1 + cos_theta);
  return std::sqrt(1 - sine2 / (effective_index * effective_index));
}

/// An interference filter. At an angle, its transmittance is that along the normal, shifted to shorter
/// wavelengths.
struct InterferenceFilter {
  Curve transmittance;     ///< Along the normal, in [0, 1].
  double effective_index;  ///< That of `blue_shift`, at least 1.
};

struct FilterStack {
  Curve fixed = Curve(1.0);  ///< Product of all factors that do not depend on the angle.
  std::vector<InterferenceFilter> shifting = {};
};

/// Upper bound of the transmittance over all angles whose cosine is at least `min_cosine`, in steps of at
/// most a nanometre. It is zero exactly where all these transmittances are zero.
[[nodiscard]] Curve envelope(const InterferenceFilter& filter, double min_cosine);

/// Response to polarised light relative to unpolarised light. A Stokes vector (I, Q, U, V) in the frame of
/// the film counts i I + c (q Q + u U + v V), where c is the contrast.
struct Analyser {
  float i = 1;  ///< 0 for a channel of one signed component (`with_stokes`).
  float q = 0;
  float u = 0;
  float v = 0;
  Curve contrast = Curve(1.0);  ///< Polarisation contrast in [0, 1].
};

/// Weights (i, c q, c u, c v) of an analyser at several wavelengths [nm].
[[nodiscard]] StokesSpectrum row_of(const Analyser& analyser, const SampledSpectrum& wavelengths_nm);

struct Polariser {
  double angle_deg = 0;  ///< Transmission axis in degrees, counterclockwise from the right of the picture.
  Curve transmittance = Curve(1.0);  ///< Transmittance of light polarised along the axis, in [0, 1].
  /// Ratio of that transmittance to the one across the axis, at least 1; infinite if absent.
  std::optional<Curve> extinction_ratio = {};
};

/// Transmitted fraction of unpolarised light: half of the sum of both transmittances.
[[nodiscard]] Curve mean_transmittance(const Polariser& polariser);
/// Analyser of a polariser, relative to its mean transmittance: the first row of its Mueller matrix. The
/// contrast is (r - 1)/(r + 1) for an extinction ratio r.
[[nodiscard]] Analyser analyser_of(const Polariser& polariser);

/// Quantity that a response multiplies: the incident energy, the incident photons, or the luminous exposure
/// for the colour-matching functions of 1931 or 1964.
enum class ResponseKind { energy, quantum, photometric, photometric_1964 };

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

/// Weight for unpolarised light at several wavelengths [nm], at this cosine of incidence on the film.
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

/// A channel of `ResponseKind::energy`: weight = response.
[[nodiscard]] Channel energy_channel(std::string name, Curve response);

/// A quantum channel: weight = response lambda/(hc). The response is in electrons per photon.
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
/// Sets the envelope of a channel with shifting filters for cosines of incidence of at least `min_cosine`.
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
/// Observer of three channels made by `observer_channels`, possibly behind filters; nothing for others.
[[nodiscard]] std::optional<Observer> standard_observer(std::span<const Channel> channels);

/// Reads the spectral sensitivities of a camera from the JSON of rawtoaces and physlight. Curves are named by
/// channel, in the order of the file. `spectral_data` contains the names of the channels in `index.main`. Its
/// `data.main` maps wavelengths [nm] to one value per channel. The values are responses to energy and zero
/// outside the table. Other members are ignored. Reports errors and returns nothing for
/// - a file that cannot be read or parsed, or lacks one of these members;
/// - units other than "relative";
/// - fewer than two wavelengths, wavelengths out of order or outside [300, 1100] nm;
/// - rows of another length, and values that are not numbers.
[[nodiscard]] std::optional<std::vector<NamedCurve>> read_camera_json(const std::filesystem::path& path,
                                                                      Diagnostics& diagnostics);

/// An angle of incidence on the film, and the fraction of a pixel's irradiance that arrives under it.
struct Incidence {
  double cos_film;  ///< Cosine of the angle to the normal of the film, in (0, 1].
  double fraction;  ///< In [0, 1].
};

/// Channel of a pixel that receives light under several angles: its weight is the mean over them and no
/// longer depends on the angle. `angles` must not be empty, and its fractions must add up to 1.
[[nodiscard]] Channel averaged(Channel channel, std::span<const Incidence> angles);

/// True if a channel depends on the angle of incidence.
[[nodiscard]] bool any_angular(std::span<const Channel> channels);

}  // namespace abbe

#pragma once

#include <span>

#include "spectral/curve.h"

namespace abbe {

/// SI 2019 defining constants.
inline constexpr double kPlanck = 6.62607015e-34;             ///< h [J s]
inline constexpr double kSpeedOfLight = 299792458.0;          ///< c [m/s]
inline constexpr double kBoltzmann = 1.380649e-23;            ///< k [J/K]
inline constexpr double kElementaryCharge = 1.602176634e-19;  ///< e [C]
inline constexpr double kAvogadro = 6.02214076e23;            ///< N_A [1/mol]

/// Energy of a photon whose label is `wavelength_nm` [J]: hc/lambda.
[[nodiscard]] constexpr double photon_energy(double wavelength_nm) {
  return kPlanck * kSpeedOfLight / (wavelength_nm * 1e-9);
}

/// Spectral radiance of a black body [W m^-2 sr^-1 nm^-1] at `temperature_K` > 0 [Planck1901].
[[nodiscard]] double planck_radiance(double temperature_K, double wavelength_nm);
[[nodiscard]] Curve planck(double temperature_K);

/// CIE daylight of correlated colour temperature `cct_K` in [4000, 25000] K, relative (100 at 560 nm) [CIE15,
/// eq. 3.3 ff.]; zero outside the tabulated components, 300-830 nm.
[[nodiscard]] Curve daylight(double cct_K);

/// `value` on [low_nm, high_nm), zero elsewhere.
[[nodiscard]] Curve band(double low_nm, double high_nm, double value = 1);

/// Gaussian of full width at half maximum `fwhm_nm` and height `peak`, sampled finely enough for any width >
/// 0.
[[nodiscard]] Curve gaussian(double center_nm, double fwhm_nm, double peak = 1);

/// An emission line: `power` spread evenly over `width_nm` around `center_nm`.
struct SpectralLine {
  double center_nm;
  double width_nm;
  double power;
};
/// The sum of lines; overlapping lines add.
[[nodiscard]] Curve lines(std::span<const SpectralLine> lines);

}  // namespace abbe

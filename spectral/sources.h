#pragma once

#include <span>

#include "spectral/curve.h"

namespace abbe {

/// Defining constants of the SI (2019).
inline constexpr double kPlanck = 6.62607015e-34;             ///< Planck constant h [J s].
inline constexpr double kSpeedOfLight = 299792458.0;          ///< Speed of light c [m/s].
inline constexpr double kBoltzmann = 1.380649e-23;            ///< Boltzmann constant k [J/K].
inline constexpr double kElementaryCharge = 1.602176634e-19;  ///< Elementary charge e [C].
inline constexpr double kAvogadro = 6.02214076e23;            ///< Avogadro constant N_A [1/mol].

/// Energy of a photon [J] of wavelength `wavelength_nm`: hc/lambda.
[[nodiscard]] constexpr double photon_energy(double wavelength_nm) {
  return kPlanck * kSpeedOfLight / (wavelength_nm * 1e-9);
}

/// Spectral radiance of a black body [W m^-2 sr^-1 nm^-1] at `temperature_K` > 0 [Planck1901].
[[nodiscard]] double planck_radiance(double temperature_K, double wavelength_nm);
[[nodiscard]] Curve planck(double temperature_K);

/// CIE daylight of correlated colour temperature `cct_K` in [4000, 25000] K [CIE15, eq. 3.3 ff.]. Relative,
/// 100 at 560 nm; zero outside the tabulated components, 300-830 nm.
[[nodiscard]] Curve daylight(double cct_K);

/// Curve that is `value` on [low_nm, high_nm) and zero elsewhere.
[[nodiscard]] Curve band(double low_nm, double high_nm, double value = 1);

/// Gaussian of full width at half maximum `fwhm_nm` > 0 and height `peak`, sampled in steps of its width.
[[nodiscard]] Curve gaussian(double center_nm, double fwhm_nm, double peak = 1);

/// Emission line: `power` spread evenly over `width_nm` around `center_nm`.
struct SpectralLine {
  double center_nm;
  double width_nm;
  double power;
};
/// Sum of emission lines; overlapping lines add.
[[nodiscard]] Curve lines(std::span<const SpectralLine> lines);

}  // namespace abbe

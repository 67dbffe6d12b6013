#pragma once

#include <span>

#include "spectral/curve.h"

namespace abbe {

/// Defining constants of the SI (2019).
inline constexpr double kPlanck = 6.62607015e-34;     ///< Planck constant h [J s].
inline constexpr double kSpeedOfLight = 299792458.0;  ///< Speed of light c [m/s].
inline constexpr double kBoltzmann = 1.380649e-23;    ///< Boltzmann constant k [J/K].
inline constexpr double kAvogadro = 6.02214076e23;    ///< Avogadro constant N_A [1/mol].

/// Energy of a photon [J]: hc/lambda. Wavelengths in air count as those in vacuum here and in
/// `planck_radiance`.
[[nodiscard]] constexpr double photon_energy(double wavelength_nm) {
  return kPlanck * kSpeedOfLight / (wavelength_nm * 1e-9);
}

/// Spectral radiance of a black body [W m^-2 sr^-1 nm^-1] at `temperature_K` > 0 and a wavelength > 0
/// [Planck1901]. Checks neither.
[[nodiscard]] double planck_radiance(double temperature_K, double wavelength_nm);
/// Radiance of a black body as a curve [W m^-2 sr^-1 nm^-1].
[[nodiscard]] Curve planck(double temperature_K);

/// CIE daylight of correlated colour temperature `cct_K` in [4000, 25000] K [CIE15, eq. 3.3 ff.]. Relative,
/// 100 at 560 nm; zero outside the tabulated components, 300-830 nm. Does not check the temperature. Throws
/// Error{input} if the shipped table of the components is missing.
[[nodiscard]] Curve daylight(double cct_K);

/// Curve that is `value` on [low_nm, high_nm) and zero elsewhere, cut to [300, 1100] nm. Throws
/// Error{internal} unless low < high.
[[nodiscard]] Curve band(double low_nm, double high_nm, double value = 1);

/// Gaussian of full width at half maximum `fwhm_nm` and height `peak`, linear between samples at 1/64 of the
/// width. It is zero from 3.5 widths off its center on. Throws Error{internal} unless the width is positive.
[[nodiscard]] Curve gaussian(double center_nm, double fwhm_nm, double peak = 1);

/// Emission line: `power`, its integral in any unit, spread evenly over `width_nm` around `center_nm`.
struct SpectralLine {
  double center_nm;
  double width_nm;
  double power;
};
/// Sum of emission lines [unit of `power` per nm]; overlapping lines add. Zero without lines. Throws
/// Error{internal} unless all widths are positive.
[[nodiscard]] Curve lines(std::span<const SpectralLine> lines);

}  // namespace abbe

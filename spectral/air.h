#pragma once

namespace abbe {

/// Refractive index of standard air (15 C, 101325 Pa, 450 ppm CO2) at a wavelength in air [nm] [Ciddor1996].
/// The formula is smooth above 200 nm; the function checks no range.
[[nodiscard]] double air_index(double wavelength_nm);

/// Conversions between the wavelength in standard air and in vacuum [nm], inverse to each other within
/// rounding.
[[nodiscard]] double air_to_vacuum(double wavelength_nm);
[[nodiscard]] double vacuum_to_air(double wavelength_nm);

}  // namespace abbe

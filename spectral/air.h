#pragma once

namespace abbe {

/// Refractive index of standard air (15 C, 101325 Pa, 450 ppm CO2) at a wavelength in air [nm] [Ciddor1996].
[[nodiscard]] double air_index(double wavelength_nm);

/// Conversions between the wavelength in standard air and in vacuum [nm].
[[nodiscard]] double air_to_vacuum(double wavelength_nm);
[[nodiscard]] double vacuum_to_air(double wavelength_nm);

}  // namespace abbe

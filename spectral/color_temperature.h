#pragma once

#include <array>
#include <optional>

#include "spectral/colorimetry.h"
#include "spectral/curve.h"

namespace abbe {

/// Coordinates u, v of the CIE 1960 uniform chromaticity scale diagram [CIE15, sec. 9.4]: u = 4X/(X + 15Y +
/// 3Z), v = 6Y/(X + 15Y + 3Z). Not finite for black.
using Uv1960 = std::array<double, 2>;
[[nodiscard]] Uv1960 uv_1960(const XYZ& xyz);

/// Colour of a light relative to the Planckian locus.
struct ColorTemperature {
  double kelvin;  ///< Correlated colour temperature.
  double duv;     ///< Distance from the Planckian locus in u, v; positive above it (greenish).
};

/// Correlated colour temperature for the CIE 1931 observer: that of the nearest black body in u, v, and the
/// signed distance to it [CIE15, sec. 9.4; Ohno2014, eq. 8]. Minimises the distance itself; black bodies are
/// summed over 360-830 nm. Nothing for colours farther than 0.05 from the locus, for which no colour
/// temperature is defined [CIE15, sec. 9.4]. Nothing below 1000 K or above 100 000 K.
[[nodiscard]] std::optional<ColorTemperature> color_temperature(const XYZ& xyz);

/// Luminous efficacy of radiation within `kVisibleRange` [lm/W] [CIE15]: 683.002 lm/W times the integral of S
/// V over that of S, by the trapezoidal rule in steps of 1 nm. Spectra with structure between whole
/// nanometres are integrated exactly.
[[nodiscard]] double luminous_efficacy(const Curve& light);

/// Ratio of scotopic to photopic luminous flux [CIE18, sec. 5]: 1700.06/683.002 times the ratio of the 1 nm
/// sums with V'(lambda) and V(lambda).
[[nodiscard]] double scotopic_photopic_ratio(const Curve& light, SumRange range = {});

}  // namespace abbe

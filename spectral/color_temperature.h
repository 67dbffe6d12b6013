#pragma once

#include <array>
#include <optional>

#include "spectral/colorimetry.h"
#include "spectral/curve.h"

namespace abbe {

/// Coordinates u, v of the CIE 1960 uniform chromaticity scale diagram: u = 4X/(X + 15Y + 3Z), v = 6Y/(X +
/// 15Y + 3Z) [CIE15, sec. 9.4]; not finite for black.
using Uv1960 = std::array<double, 2>;
[[nodiscard]] Uv1960 uv_1960(const XYZ& xyz);

/// How near a light's colour is to that of a black body.
struct ColorTemperature {
  double kelvin;  ///< Correlated colour temperature.
  double duv;     ///< Distance from the Planckian locus in u, v, positive above it (greenish).
};

/// The temperature of the black body whose chromaticity for the CIE 1931 observer is nearest in u, v, and the
/// signed distance to it [CIE15, sec. 9.4; Ohno2014, eq. 8], found by minimising that distance itself; black
/// bodies are summed over 360-830 nm. Nothing for colours farther than 0.05 from the locus, of which no
/// colour temperature is told [CIE15, sec. 9.4], and for temperatures below 1000 K or above 100 000 K.
[[nodiscard]] std::optional<ColorTemperature> color_temperature(const XYZ& xyz);

/// Luminous efficacy of the visible part of a radiation [lm/W] (`kVisibleRange`): 683.002 lm/W times the
/// integral of S V over that of S by the trapezoidal rule in steps of 1 nm [CIE15]. Spectra with structure
/// between whole nanometres are integrated exactly.
[[nodiscard]] double luminous_efficacy(const Curve& light);

/// Ratio of scotopic to photopic luminous flux: 1700.06/683.002 times the quotient of the 1 nm sums with
/// V'(lambda) and V(lambda) [CIE18, sec. 5].
[[nodiscard]] double scotopic_photopic_ratio(const Curve& light, SumRange range = {});

}  // namespace abbe

#pragma once

#include <array>
#include <optional>

#include "spectral/colorimetry.h"
#include "spectral/curve.h"

namespace abbe {

/// Coordinates u, v of the CIE 1960 uniform chromaticity scale diagram [CIE15, sec. 9.4]: u = 4X/(X + 15Y +
/// 3Z), v = 6Y/(X + 15Y + 3Z).
using Uv1960 = std::array<double, 2>;
/// Coordinates u, v of tristimulus values in any scale; NaN for black.
[[nodiscard]] Uv1960 uv_1960(const XYZ& xyz);

/// Colour of a light relative to the Planckian locus.
struct ColorTemperature {
  double kelvin;  ///< Correlated colour temperature, 1000 to 100 000 K.
  double duv;     ///< Distance from the Planckian locus in u, v; positive above it (greenish).
};

/// Correlated colour temperature for the CIE 1931 observer: that of the nearest black body in u, v, and the
/// signed distance to it [CIE15, sec. 9.4; Ohno2014, eq. 8]. Minimises the distance itself; black bodies are
/// summed over 360-830 nm. The scale of `xyz` has no influence. Nothing for colours farther than 0.05 from
/// the locus, for which no colour temperature is defined [CIE15, sec. 9.4]. Nothing below 1000 K or above 100
/// 000 K, and nothing for black. Throws Error{input} if the shipped observer table is missing.
[[nodiscard]] std::optional<ColorTemperature> color_temperature(const XYZ& xyz);

/// Luminous efficacy of radiation within `kVisibleRange` [lm/W] [CIE15]: 683.002 lm/W times the integral of S
/// V over that of S. The integral of S is exact. That of S V is the trapezoidal rule in steps of 1 nm, or
/// exact if S has structure between whole nanometres (`sum_product`). NaN for a light that is 0 in this
/// range. Throws Error{input} if the shipped observer table is missing.
[[nodiscard]] double luminous_efficacy(const Curve& light);

/// Ratio of scotopic to photopic luminous flux [CIE18, sec. 5]: 1700.06/683.002 times the ratio of the 1 nm
/// sums with V'(lambda) and V(lambda) over `range`. NaN or infinite for a light without photopic flux. Throws
/// Error{input} if a shipped table is missing.
[[nodiscard]] double scotopic_photopic_ratio(const Curve& light, SumRange range = {});

}  // namespace abbe

#pragma once

#include <array>
#include <string>

#include "spectral/colorimetry.h"
#include "spectral/rgb.h"

namespace abbe {

/// sRGB code values, each in [0, 1].
using DisplayColor = std::array<double, 3>;

/// Linear Rec.709 values of L*a*b*, whose white is that of the display.
[[nodiscard]] LinearRgb linear_rgb(const Lab& lab);
/// Linear Rec.709 values of XYZ, with Y = 1 for the D65 white.
[[nodiscard]] LinearRgb linear_rgb_of_xyz(const XYZ& xyz);

/// sRGB code values of linear Rec.709, clamped to the displayable range; transfer function of IEC 61966-2-1.
[[nodiscard]] DisplayColor display_code(const LinearRgb& linear);

/// The colour as "#rrggbb".
[[nodiscard]] std::string css_color(const DisplayColor& color);

}  // namespace abbe

#pragma once

#include <array>
#include <string>

#include "spectral/colorimetry.h"
#include "spectral/rgb.h"

namespace abbe {

/// sRGB code values, each in [0, 1].
using DisplayColor = std::array<double, 3>;

/// Linear Rec.709 of L*a*b*, its white being the display's.
[[nodiscard]] LinearRgb linear_rgb(const Lab& lab);
/// Linear Rec.709 of XYZ with Y = 1 for the white D65.
[[nodiscard]] LinearRgb linear_rgb_of_xyz(const XYZ& xyz);

/// Code values of linear Rec.709, clamped to what displays show, by the transfer function of IEC 61966-2-1.
[[nodiscard]] DisplayColor display_code(const LinearRgb& linear);

/// The colour as SVG and HTML name it: "#rrggbb".
[[nodiscard]] std::string css_color(const DisplayColor& color);

}  // namespace abbe

#pragma once

#include <array>
#include <string>

#include "spectral/colorimetry.h"
#include "spectral/rgb.h"

namespace abbe {

/// sRGB code values, each in [0, 1].
using DisplayColor = std::array<double, 3>;

/// Linear Rec.709 values of L*a*b* relative to the D65 white of the display, which is (1, 1, 1). Colours
/// outside the gamut have values outside [0, 1].
[[nodiscard]] LinearRgb linear_rgb(const Lab& lab);
/// Linear Rec.709 values of XYZ, in which the D65 white of the display has Y = 1. Colours outside the gamut
/// have values outside [0, 1].
[[nodiscard]] LinearRgb linear_rgb_of_xyz(const XYZ& xyz);

/// sRGB code values of linear Rec.709 values, which are clamped to [0, 1]; transfer function of IEC
/// 61966-2-1.
[[nodiscard]] DisplayColor display_code(const LinearRgb& linear);

/// The colour as "#rrggbb", with each code value rounded to 8 bits.
[[nodiscard]] std::string css_color(const DisplayColor& color);

}  // namespace abbe

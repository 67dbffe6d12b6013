#pragma once

#include <array>
#include <span>
#include <string>

#include "io/image.h"
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

/// Colour for a position `t` on a scale, clamped to [0, 1] and rounded to one of 256 steps; `t` must not be
/// NaN. CIE 1976 lightness increases linearly from 12 to 92, and hue changes from blue over red to yellow.
/// Chroma stays inside the sRGB gamut. The order of colours is also visible in grey prints and to
/// colour-blind readers.
[[nodiscard]] DisplayColor map_color(double t);

/// Colour of a cyclic quantity, with period 1 in `turn`, at CIE 1976 lightness 65. A `turn` of 0 is red;
/// yellow, green and blue follow as it grows. Chroma grows with `strength`, clamped to [0, 1], from grey to
/// the largest value that sRGB has at all hues.
[[nodiscard]] DisplayColor cyclic_color(double turn, double strength);

/// False-colour image of `width` x `height` values, row by row, by `map_color` from `low` (dark) to `high`
/// (bright). Values outside the range have the colour of its nearer end; values that are not finite are grey.
/// If `high` is not above `low`, all pixels are dark. The channels R, G and B are sRGB code values in [0, 1].
[[nodiscard]] Image false_color(std::span<const double> values, int width, int height, double low,
                                double high);

}  // namespace abbe

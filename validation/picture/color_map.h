#pragma once

#include <span>

#include "io/image.h"
#include "validation/picture/display_color.h"

namespace abbe {

/// Colour for a position `t` on a scale, clamped to [0, 1]. CIE 1976 lightness increases linearly from 12 to
/// 92, and hue changes from blue over red to yellow. Chroma stays inside the sRGB gamut. The order of colours
/// is also visible in grey prints and to colour-blind readers.
[[nodiscard]] DisplayColor map_color(double t);

/// Colour of a cyclic quantity, with period 1 in `turn`, at CIE 1976 lightness 65. Hue passes red, yellow,
/// green and blue. Chroma grows with `strength`, clamped to [0, 1], from grey to the largest value that sRGB
/// has at all hues.
[[nodiscard]] DisplayColor cyclic_color(double turn, double strength);

/// False-colour image of `values` in row order, from `low` (dark) to `high`. Values that are not finite are
/// grey.
[[nodiscard]] Image false_color(std::span<const double> values, int width, int height, double low,
                                double high);

}  // namespace abbe

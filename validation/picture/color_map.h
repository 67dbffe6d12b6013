#pragma once

#include <span>

#include "io/image.h"
#include "validation/picture/display_color.h"

namespace abbe {

/// A colour for a share in [0, 1] of a scale, clamped there: CIE 1976 lightness grows evenly from 12 to 92
/// while hue turns from blue over red to yellow, at most of what chroma sRGB has there, so that order shows
/// in print and to any eye.
[[nodiscard]] DisplayColor map_color(double share);

/// A colour for a place on a cycle, of which 1 is a turn, at CIE 1976 lightness 65: the hue goes round once,
/// from red over yellow and green to blue, and chroma grows from grey to the most that an sRGB display has of
/// all hues there with a strength in [0, 1], clamped there.
[[nodiscard]] DisplayColor cyclic_color(double turn, double strength);

/// One plane of an image, row by row, from `low` (dark) to `high`; grey where a value is not finite.
[[nodiscard]] Image false_color(std::span<const double> values, int width, int height, double low,
                                double high);

}  // namespace abbe

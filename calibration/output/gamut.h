#pragma once

#include <array>
#include <limits>

#include "spectral/rgb.h"

namespace abbe {

/// Gamut of a display or a view: linear RGB of `space` from 0 to `top`, which is infinite by default.
struct Gamut {
  explicit Gamut(const RgbSpace& space, double top = std::numeric_limits<double>::infinity());

  Matrix3 to_xyz_d65;               ///< Converts linear RGB to XYZ relative to D65 (`rgb_to_xyz_d65`).
  Matrix3 from_xyz_d65;             ///< Inverse of `to_xyz_d65`.
  std::array<double, 3> luminance;  ///< Luminances of the primaries, which add up to 1.
  double top;                       ///< Largest value of a primary.
};

/// A colour mapped into a gamut.
struct MappedColor {
  std::array<double, 3> rgb{};  ///< Linear RGB from 0 to `top`.
  /// True if a primary was below zero by more than rounding: the display cannot show such a colour.
  bool outside = false;
  /// True if a primary still exceeded `top` by more than rounding, or if a value was not finite.
  bool too_bright = false;
};

/// Maps linear RGB into the gamut. A colour with a negative primary moves on the straight line towards the
/// grey of its own luminance, only as far as necessary. Luminance is preserved, and so is hue, as the
/// direction from white in the chromaticity diagram. A colour without positive luminance becomes black, and
/// so does one that is not finite. A colour that is then too bright is dimmed at constant chromaticity.
[[nodiscard]] MappedColor map_into(const Gamut& gamut, const std::array<double, 3>& rgb);

}  // namespace abbe

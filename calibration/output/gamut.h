#pragma once

#include <array>
#include <limits>

#include "spectral/rgb.h"

namespace abbe {

/// The colours a display or a view can take in: linear RGB of `space` from 0 to `top`.
struct Gamut {
  explicit Gamut(const RgbSpace& space, double top = std::numeric_limits<double>::infinity());

  Matrix3 to_xyz_d65;
  Matrix3 from_xyz_d65;
  std::array<double, 3> luminance;  ///< Of the primaries, 1 in all.
  double top;
};

/// A colour brought into a gamut.
struct MappedColor {
  std::array<double, 3> rgb{};
  bool outside = false;     ///< A primary was below zero by more than rounding: no such colour can be shown.
  bool too_bright = false;  ///< A primary was above `top` by more than rounding even then.
};

/// Brings linear RGB into the gamut. A colour that has a negative primary goes along the straight line to the
/// grey of its own luminance, as far as needed and no further: luminance stays, and so does hue, as the
/// direction from white in the chromaticity diagram. One of no positive luminance becomes black. What is then
/// too bright is dimmed at its chromaticity.
[[nodiscard]] MappedColor map_into(const Gamut& gamut, const std::array<double, 3>& rgb);

}  // namespace abbe

#pragma once

namespace abbe {

/// The share of pixels up to which those at an end of the scale are taken for defective, as hot, stuck and
/// dead ones are whatever the light: more are there by the light.
inline constexpr double kMostDefective = 0.01;

/// Whether so many of `pixels` are at an end of the scale by the light.
[[nodiscard]] constexpr bool exceeds_defects(double at_end, double pixels) {
  return at_end > kMostDefective * pixels;
}

}  // namespace abbe

#pragma once

namespace abbe {

/// Largest fraction of black or saturated pixels that counts as defective. Hot, stuck and dead pixels occur
/// at any light; a larger fraction is due to the light.
inline constexpr double kMaxDefectiveFraction = 0.01;

/// True if `at_end` black or saturated ones among `pixels` pixels are too many to be defective, so that the
/// light causes them.
[[nodiscard]] constexpr bool exceeds_defects(double at_end, double pixels) {
  return at_end > kMaxDefectiveFraction * pixels;
}

}  // namespace abbe

#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <ImathVec.h>

namespace abbe {

/// Uniform on the unit disc from `u` in [0, 1)^2, keeping neighbours together: squares go to rings.
/// [Shirley1997]
[[nodiscard]] inline Imath::V2f concentric_disc(const Imath::V2f& u) {
  constexpr float kQuarter = std::numbers::pi_v<float> / 4;
  const float a = 2 * u.x - 1;
  const float b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool along_x = std::abs(a) > std::abs(b);
  const float radius = along_x ? a : b;
  const float angle = along_x ? kQuarter * (b / a) : kQuarter * (2 - a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Direction with z >= 0 and density cos/pi [1/sr] about z.
[[nodiscard]] inline Imath::V3f cosine_hemisphere(const Imath::V2f& u) {
  const float radius = std::max(std::abs(2 * u.x - 1), std::abs(2 * u.y - 1));  // that of the disc point
  const Imath::V2f disc = concentric_disc(u);
  return {disc.x, disc.y, std::sqrt((1 - radius) * (1 + radius))};
}

}  // namespace abbe

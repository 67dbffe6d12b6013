#pragma once

#include <numbers>

namespace abbe {

/// One degree in radians.
inline constexpr double kDegree = std::numbers::pi / 180;

}  // namespace abbe

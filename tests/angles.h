#pragma once

#include <numbers>

#include "sampling/angle.h"

namespace abbe {

inline constexpr double kPi = std::numbers::pi;

}  // namespace abbe

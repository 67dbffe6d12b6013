#pragma once

namespace abbe {

/// Tolerance of Mueller elements in float against those in double.
inline constexpr double kMuellerFloat = 1e-5;

}  // namespace abbe

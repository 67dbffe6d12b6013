#pragma once

namespace abbe {

/// How far elements of Mueller matrices in float may be from theirs in double.
inline constexpr double kMuellerFloat = 1e-5;

}  // namespace abbe

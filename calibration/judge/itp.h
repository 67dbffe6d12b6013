#pragma once

#include <array>

#include "spectral/colorimetry.h"

namespace abbe {

/// Luminance of the diffuse white of pictures that tell none: graphics white of [BT2408, sec. 2.2] [cd/m^2].
inline constexpr double kReferenceWhite = 203;

/// I, T, P of a colour given by absolute tristimulus values [cd/m^2] beside a white D65: IC_TC_P by the
/// perceptual quantiser [BT2100, table 7], with T = C_T/2 [BT2124, annex 1].
[[nodiscard]] std::array<double, 3> itp(const XYZ& absolute);

/// Delta E_ITP, 1 of which is just noticeable at best: 720 sqrt(dI^2 + dT^2 + dP^2) [BT2124, annex 1].
[[nodiscard]] double delta_e_itp(const std::array<double, 3>& a, const std::array<double, 3>& b);

}  // namespace abbe

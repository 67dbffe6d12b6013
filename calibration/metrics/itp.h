#pragma once

#include <array>

#include "spectral/colorimetry.h"

namespace abbe {

/// Luminance of the diffuse white of pictures that do not record it: graphics white of [BT2408, sec. 2.2]
/// [cd/m^2].
inline constexpr double kReferenceWhite = 203;

/// I, T, P of a colour with absolute tristimulus values [cd/m^2], relative to a white D65: IC_TC_P with the
/// perceptual quantiser [BT2100, table 7], and T = C_T/2 [BT2124, annex 1].
[[nodiscard]] std::array<double, 3> itp(const XYZ& absolute);

/// Delta E_ITP of two results of `itp`, 720 sqrt(dI^2 + dT^2 + dP^2) [BT2124, annex 1]. A value of 1 is just
/// noticeable under the best conditions.
[[nodiscard]] double delta_e_itp(const std::array<double, 3>& a, const std::array<double, 3>& b);

}  // namespace abbe

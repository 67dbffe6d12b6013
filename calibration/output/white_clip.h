#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Film values t r_k, for channel k, of the brightest neutral below saturation. The film values r of a
/// neutral are those that `to_xyz_d65` maps to D65. The level t = min_k saturation_k / r_k is that at which
/// the first channel saturates in neutral light. `saturation` has the film value of each of three channels at
/// which it saturates. Empty if no neutral is positive in every channel below saturation.
[[nodiscard]] std::optional<std::array<double, 3>> brightest_neutral(const Matrix3& to_xyz_d65,
                                                                     const std::vector<double>& saturation);

/// Clips every channel of `planes` at the `brightest_neutral`, so that saturated pixels become white.
/// Channels saturate at values that are not neutral, which would make bright white light look cyan or
/// magenta. `channels` are the three names in the order of `saturation`; planes of other names remain. Does
/// nothing if there is no such neutral.
void clip_to_white(Image& planes, const std::vector<std::string>& channels, const Matrix3& to_xyz_d65,
                   const std::vector<double>& saturation);

}  // namespace abbe

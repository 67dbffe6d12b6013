#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Film values of the brightest neutral below saturation: t r_k for channel k. r are the film values of a
/// neutral, which `to_xyz_d65` takes to D65. t = min_k saturation_k / r_k is where the first channel
/// saturates in neutral light. Empty if no neutral is positive in every channel below saturation.
[[nodiscard]] std::optional<std::array<double, 3>> brightest_neutral(const Matrix3& to_xyz_d65,
                                                                     const std::vector<double>& saturation);

/// Makes white of what saturated: channels fill up at values that are no neutral, so that too much white
/// light would look cyan or magenta. Every channel is cut at the `brightest_neutral`. Channels are in the
/// order of `channels`, which are all there. Does nothing where there is no such neutral.
void clip_to_white(Image& planes, const std::vector<std::string>& channels, const Matrix3& to_xyz_d65,
                   const std::vector<double>& saturation);

}  // namespace abbe

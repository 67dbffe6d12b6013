#pragma once

#include <string>
#include <vector>

#include "io/image.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Makes white of what saturated: channels fill up at values that are no neutral, so that too much white
/// light would look cyan or magenta. With r the film values of a neutral, which `to_xyz_d65` takes to D65,
/// every channel k is cut at t r_k, t = min_k saturation_k / r_k being where the first of them fills up in
/// neutral light. Channels are in the order of `channels`, which are all there. Does nothing where no neutral
/// is positive in every channel below saturation.
void clip_to_white(Image& planes, const std::vector<std::string>& channels, const Matrix3& to_xyz_d65,
                   const std::vector<double>& saturation);

}  // namespace abbe

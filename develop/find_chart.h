#pragma once

#include <array>

#include <Imath/ImathVec.h>

#include "develop/linear_image.h"

namespace abbe {

/// Finds a ColorChecker of 24 patches in an image of any kind, whichever way up it is, by the module that
/// looks for charts as people see them: its channels R, G, B, or X, Y, Z; of others, in the order of the
/// rainbow either way, the first, middle and last; the one of a grey image. Returns the corners that
/// `outlines_between` takes, a pixel or two from the truth. Throws Error{input} where there is none, and
/// where the module is missing.
[[nodiscard]] std::array<Imath::V2d, 4> find_chart(const LinearImage& image);

}  // namespace abbe

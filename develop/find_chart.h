#pragma once

#include <array>

#include <Imath/ImathVec.h>

#include "develop/linear_image.h"

namespace abbe {

/// Finds a ColorChecker of 24 patches, in any orientation, by the chart detector module. The detector needs
/// red, green and blue: channels R, G, B or X, Y, Z if the image has them. Otherwise the first, central and
/// last channel are tried in order of wavelength and in reverse; a grey image uses its one channel. Returns
/// the corners that `outlines_between` takes, accurate to a pixel or two. They are ordered as the chart is
/// read: top left, top right, bottom right, bottom left. Throws Error{input} if there is no chart or the
/// module is missing.
[[nodiscard]] std::array<Imath::V2d, 4> find_chart(const LinearImage& image);

}  // namespace abbe

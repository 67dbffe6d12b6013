#pragma once

#include "io/image.h"

namespace abbe {

/// The attribute that says on which sides of the picture the first row and the first column of an image are,
/// from 2 to 8 as Exif counts [Exif, sec. 4.6.4]; an image without it stands upright.
inline constexpr const char* kOrientation = "Orientation";

/// The image as it is to be seen: its pixels turned and mirrored as its `kOrientation` says, which it tells
/// no longer.
[[nodiscard]] Image upright(Image image);

}  // namespace abbe

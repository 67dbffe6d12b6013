#pragma once

#include "io/image.h"

namespace abbe {

/// Metadata key for the orientation of an image: 2 to 8 name the sides of the picture that its first row and
/// first column are on [Exif, sec. 4.6.4]. Without it, rows run from top to bottom and columns from left to
/// right.
inline constexpr const char* kOrientation = "Orientation";

/// The image with the rotation and reflection applied that its `kOrientation` declares. The attribute is
/// removed.
[[nodiscard]] Image apply_orientation(Image image);

}  // namespace abbe

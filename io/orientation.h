#pragma once

#include "io/image.h"

namespace abbe {

/// Metadata key for the orientation of an image, the number of Exif [Exif, sec. 4.6.4]. Without it, or with
/// 1, rows run from top to bottom and columns from left to right. To display the stored pixels:
/// - 2 and 4 reflect left to right and top to bottom, 3 turns by 180 degrees;
/// - 6 and 8 turn by 90 degrees, clockwise and counter-clockwise;
/// - 5 and 7 transpose at the main and at the other diagonal.
inline constexpr const char* kOrientation = "Orientation";

/// The image as displayed: `kOrientation` is applied to all channels and removed. Pixels are unchanged if it
/// is absent or not a number from 1 to 8. Numbers from 5 on exchange width and height.
[[nodiscard]] Image apply_orientation(Image image);

}  // namespace abbe

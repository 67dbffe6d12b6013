#pragma once

#include "io/image.h"
#include "sensor/film/crop.h"

namespace abbe {

/// Throws Error{input} for images of different size.
void require_same_size(const Image& image, const Image& reference);

/// The pixels that two films of one size both have, by the crops they tell. Throws Error{input} for films of
/// different size, and for crops without a common pixel.
[[nodiscard]] Crop common_part(const Image& image, const Image& reference);

/// Those pixels of an image as an image of their own, which tells all else.
[[nodiscard]] Image part_of(const Image& image, const Crop& part);

}  // namespace abbe

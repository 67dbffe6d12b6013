#pragma once

#include <span>
#include <vector>

#include "io/image.h"
#include "sensor/film/crop.h"

namespace abbe {

/// Throws Error{input} for images of different size.
void require_same_size(const Image& image, const Image& reference);

/// The pixels that two films of one size both have, by the crops and areas they tell, as disjoint rectangles.
/// Throws Error{input} for films of different size, and for films without a common pixel.
[[nodiscard]] std::vector<Crop> common_part(const Image& image, const Image& reference);

/// Those pixels of an image as an image of their own, which tells all else: a rectangle as it is, and of
/// several all pixels in a row.
[[nodiscard]] Image part_of(const Image& image, std::span<const Crop> part);

}  // namespace abbe

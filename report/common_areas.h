#pragma once

#include <span>
#include <vector>

#include "io/image.h"
#include "sensor/film/crop.h"

namespace abbe {

/// Throws Error{input} if the images differ in size.
void require_same_size(const Image& image, const Image& reference);

/// Pixels that both films contain, by the crops and areas that they record, as disjoint rectangles. A film
/// without a valid record contains all its pixels. Throws Error{input} for films of different size and for
/// films without a common pixel.
[[nodiscard]] std::vector<Crop> common_areas(const Image& image, const Image& reference);

/// Image of the pixels inside `areas`, with the metadata of `image` except its crop and areas. A single
/// rectangle retains its shape. The pixels of several are concatenated to one row, area by area and row by
/// row. There must be at least one area, and all must lie inside the image.
[[nodiscard]] Image extract_areas(const Image& image, std::span<const Crop> areas);

}  // namespace abbe

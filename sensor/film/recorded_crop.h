#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "io/image.h"
#include "sensor/film/crop.h"

namespace abbe {

/// Crop that a film or a file developed from it records; nothing if it has all pixels, or if the record is
/// malformed or exceeds the image.
[[nodiscard]] std::optional<Crop> recorded_crop(const Image& film);

/// Recorded pixels of a film as disjoint rectangles. A film merged from parts can have several; without a
/// crop, one rectangle contains all pixels. A malformed `kAreasKey` counts as absent.
[[nodiscard]] std::vector<Crop> recorded_areas(const Image& film);

/// Indices y width + x of the recorded pixels, area by area and row by row.
[[nodiscard]] std::vector<std::size_t> recorded_pixels(const Image& film);

}  // namespace abbe

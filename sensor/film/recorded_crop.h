#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "io/image.h"
#include "sensor/film/crop.h"

namespace abbe {

/// The pixels that a film, or what was developed of it, tells to have; nothing where it has all.
[[nodiscard]] std::optional<Crop> recorded_crop(const Image& film);

/// The same as disjoint rectangles, of which a film that is merged of some parts may tell several: one of all
/// pixels where it has all.
[[nodiscard]] std::vector<Crop> recorded_areas(const Image& film);

/// The same as numbers of pixels, area by area and row by row.
[[nodiscard]] std::vector<std::size_t> recorded_pixels(const Image& film);

}  // namespace abbe

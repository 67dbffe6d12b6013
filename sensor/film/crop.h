#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/image.h"

namespace abbe {

/// Rectangle of pixels of a film: x0 <= x < x1, y0 <= y < y1, from the top left corner.
struct Crop {
  int x0, y0, x1, y1;

  bool operator==(const Crop&) const = default;
};

/// Attribute with the crop of a film, "x0,y0,x1,y1"; absent if the film has all pixels.
inline constexpr const char* kCropKey = "crop";

/// Attribute with the rectangles of a film whose crop has gaps, and the ranges first:end of the samples of
/// each. Example: "0,0,2,2=0:8 3,2,6,4=0:4,5:8".
inline constexpr const char* kAreasKey = "areas";

[[nodiscard]] inline std::size_t pixel_count(const Crop& c) {
  return static_cast<std::size_t>(c.x1 - c.x0) * static_cast<std::size_t>(c.y1 - c.y0);
}

/// Intersection of two rectangles, or nothing if it is empty.
[[nodiscard]] std::optional<Crop> common_pixels(const Crop& a, const Crop& b);

/// Conversion between a rectangle and the text "x0,y0,x1,y1". Parsing gives nothing for any other text, for
/// negative edges and for empty rectangles; it knows no film size.
[[nodiscard]] std::string to_text(const Crop& crop);
[[nodiscard]] std::optional<Crop> parse_crop(std::string_view text);
/// Text of several rectangles, separated by spaces.
[[nodiscard]] std::string to_text(const std::vector<Crop>& areas);

/// Recorded pixels of a film, or of a file developed from it, as disjoint rectangles. A film merged from
/// parts can have several; without a crop, one rectangle contains all pixels. A malformed attribute counts as
/// absent.
[[nodiscard]] std::vector<Crop> recorded_areas(const Image& film);

/// Indices y width + x of the recorded pixels, area by area and row by row.
[[nodiscard]] std::vector<std::size_t> recorded_pixels(const Image& film);

}  // namespace abbe

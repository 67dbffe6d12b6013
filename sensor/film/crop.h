#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace abbe {

/// A rectangle of a film in pixels: x0 <= x < x1, y0 <= y < y1.
struct Crop {
  int x0, y0, x1, y1;

  bool operator==(const Crop&) const = default;
};

/// The key of the pixels that a film has, "x0,y0,x1,y1"; absent where it has all.
inline constexpr const char* kCropKey = "crop";

/// The key of the pixels that a film has where they leave gaps within its crop, each rectangle with its
/// samples: "x0,y0,x1,y1=0:16 ...".
inline constexpr const char* kAreasKey = "areas";

[[nodiscard]] inline std::size_t pixel_count(const Crop& c) {
  return static_cast<std::size_t>(c.x1 - c.x0) * static_cast<std::size_t>(c.y1 - c.y0);
}

/// The pixels that two rectangles both have, if there are some.
[[nodiscard]] std::optional<Crop> common_pixels(const Crop& a, const Crop& b);

/// A rectangle as text "x0,y0,x1,y1", and back; nothing for any other text, negative edges and empty ones.
[[nodiscard]] std::string to_text(const Crop& crop);
[[nodiscard]] std::optional<Crop> parse_crop(std::string_view text);
/// Several, with spaces between them.
[[nodiscard]] std::string to_text(const std::vector<Crop>& areas);

}  // namespace abbe

#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace abbe {

/// A rectangle of a film in pixels: x0 <= x < x1, y0 <= y < y1.
struct Crop {
  int x0, y0, x1, y1;

  bool operator==(const Crop&) const = default;
};

/// The key of the pixels that a film has, "x0,y0,x1,y1"; absent where it has all.
inline constexpr const char* kCropKey = "crop";

/// A rectangle as text "x0,y0,x1,y1", and back; nothing for any other text, negative edges and empty ones.
[[nodiscard]] std::string to_text(const Crop& crop);
[[nodiscard]] std::optional<Crop> parse_crop(std::string_view text);

}  // namespace abbe

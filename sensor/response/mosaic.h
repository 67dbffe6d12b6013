#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace abbe {

/// Filters laid over single pixels: a pattern of channels that repeats over the film from its top left
/// corner, as R G / G B. The film of a mosaic has one plane, `kRawPlane`, that holds at each pixel the value
/// of the pixel's own channel, in that channel's unit: what the same scene's film without the mosaic expects
/// in that channel's plane there.
struct Mosaic {
  int width = 1;
  int height = 1;
  std::vector<int> channel;  ///< Numbers among the sensor's channels, row by row.

  /// The channel of pixel (x, y), both not negative.
  [[nodiscard]] int at(int x, int y) const {
    return channel[static_cast<std::size_t>(y % height) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(x % width)];
  }
  bool operator==(const Mosaic&) const = default;
};

/// Name of the one plane of a mosaic's film.
inline constexpr const char* kRawPlane = "raw";

/// A pattern in words, as "R,G/G,B": rows from the top, the channels by their names.
[[nodiscard]] std::string to_text(const Mosaic& mosaic, std::span<const std::string> names);
/// The pattern of such words; nothing unless all rows have the same length and all names are known.
[[nodiscard]] std::optional<Mosaic> parse_mosaic(std::string_view text, std::span<const std::string> names);

}  // namespace abbe

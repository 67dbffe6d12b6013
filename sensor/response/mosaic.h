#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace abbe {

/// Filters on individual pixels: a pattern of channels that repeats from the top left corner of the film,
/// such as R G / G B. The film of a mosaic has one plane, `kRawPlane`. Each pixel contains the value of its
/// own channel, in that channel's unit. It has the same expectation as that channel's plane of a film without
/// the mosaic.
struct Mosaic {
  int width = 1;
  int height = 1;
  std::vector<int> channel;  ///< Indices of the sensor's channels, row by row.

  /// Channel of pixel (x, y), x and y >= 0.
  [[nodiscard]] int at(int x, int y) const {
    return channel[static_cast<std::size_t>(y % height) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(x % width)];
  }
  bool operator==(const Mosaic&) const = default;
};

inline constexpr const char* kRawPlane = "raw";  ///< Name of the only plane of a mosaic's film.

/// Text of a pattern, such as "R,G/G,B": rows from the top, channels by their `names` in the order of the
/// sensor.
[[nodiscard]] std::string to_text(const Mosaic& mosaic, std::span<const std::string> names);
/// Parses a pattern. Nothing unless all rows have the same length and all names are known.
[[nodiscard]] std::optional<Mosaic> parse_mosaic(std::string_view text, std::span<const std::string> names);

}  // namespace abbe

#include "sensor/film/crop.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {

std::optional<Crop> common_pixels(const Crop& a, const Crop& b) {
  const Crop both{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  return both.x0 < both.x1 && both.y0 < both.y1 ? std::optional(both) : std::nullopt;
}

std::string to_text(const Crop& crop) {
  return fmt::format("{},{},{},{}", crop.x0, crop.y0, crop.x1, crop.y1);
}

std::optional<Crop> parse_crop(std::string_view text) {
  std::vector<int> edges;
  for (const std::string& piece : split(text, ',')) {
    int& edge = edges.emplace_back();
    const auto [end, error] = std::from_chars(piece.data(), piece.data() + piece.size(), edge);
    if (error != std::errc() || end != piece.data() + piece.size()) return std::nullopt;
  }
  if (edges.size() != 4 || edges[0] < 0 || edges[1] < 0 || edges[0] >= edges[2] || edges[1] >= edges[3])
    return std::nullopt;
  return Crop{edges[0], edges[1], edges[2], edges[3]};
}

std::string to_text(const std::vector<Crop>& areas) {
  std::string text;
  for (const Crop& area : areas) text += (text.empty() ? "" : " ") + to_text(area);
  return text;
}

}  // namespace abbe

#include "sensor/film/crop.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {
namespace {

// The recorded crop; nothing if the film has all pixels, or if the record is malformed or exceeds the image.
std::optional<Crop> recorded_crop(const Image& film) {
  const auto entry = film.metadata.find(kCropKey);
  if (entry == film.metadata.end()) return std::nullopt;
  const std::optional<Crop> crop = parse_crop(entry->second);
  return crop && crop->x1 <= film.width && crop->y1 <= film.height ? crop : std::nullopt;
}

}  // namespace

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

std::vector<Crop> recorded_areas(const Image& film) {
  const Crop around = recorded_crop(film).value_or(Crop{0, 0, film.width, film.height});
  const auto entry = film.metadata.find(kAreasKey);
  if (entry == film.metadata.end()) return {around};
  std::vector<Crop> areas;
  std::size_t recorded = 0;
  for (const std::string& area : split(entry->second, ' ')) {
    const std::optional<Crop> pixels = parse_crop(area.substr(0, area.find('=')));
    if (!pixels || common_pixels(*pixels, around) != pixels) return {around};
    areas.push_back(*pixels);
    recorded += pixel_count(*pixels);
  }
  return recorded < pixel_count(around) ? areas : std::vector<Crop>{around};
}

std::vector<std::size_t> recorded_pixels(const Image& film) {
  std::vector<std::size_t> pixels;
  for (const Crop& area : recorded_areas(film))
    for (int y = area.y0; y < area.y1; ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width);
      for (int x = area.x0; x < area.x1; ++x) pixels.push_back(row + static_cast<std::size_t>(x));
    }
  return pixels;
}

}  // namespace abbe

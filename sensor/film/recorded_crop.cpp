#include "sensor/film/recorded_crop.h"

#include <string>

#include "io/text.h"

namespace abbe {

std::optional<Crop> recorded_crop(const Image& film) {
  const auto entry = film.metadata.find(kCropKey);
  if (entry == film.metadata.end()) return std::nullopt;
  const std::optional<Crop> crop = parse_crop(entry->second);
  return crop && crop->x1 <= film.width && crop->y1 <= film.height ? crop : std::nullopt;
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

#include "sensor/film/recorded_crop.h"

#include <string>

#include "io/text.h"

namespace abbe {

std::optional<Crop> recorded_crop(const Image& film) {
  const auto found = film.metadata.find(kCropKey);
  if (found == film.metadata.end()) return std::nullopt;
  const std::optional<Crop> crop = parse_crop(found->second);
  return crop && crop->x1 <= film.width && crop->y1 <= film.height ? crop : std::nullopt;
}

std::vector<Crop> recorded_areas(const Image& film) {
  const Crop around = recorded_crop(film).value_or(Crop{0, 0, film.width, film.height});
  const auto found = film.metadata.find(kAreasKey);
  if (found == film.metadata.end()) return {around};
  std::vector<Crop> areas;
  for (const std::string& area : split(found->second, ' ')) {
    const std::optional<Crop> pixels = parse_crop(area.substr(0, area.find('=')));
    if (!pixels || common_pixels(*pixels, around) != pixels) return {around};
    areas.push_back(*pixels);
  }
  return areas;
}

}  // namespace abbe

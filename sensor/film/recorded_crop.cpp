#include "sensor/film/recorded_crop.h"

namespace abbe {

std::optional<Crop> recorded_crop(const Image& film) {
  const auto found = film.metadata.find(kCropKey);
  if (found == film.metadata.end()) return std::nullopt;
  const std::optional<Crop> crop = parse_crop(found->second);
  return crop && crop->x1 <= film.width && crop->y1 <= film.height ? crop : std::nullopt;
}

}  // namespace abbe

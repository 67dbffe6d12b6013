#include "report/common_areas.h"

#include <fmt/format.h>

#include "sensor/film/crop.h"

namespace abbe {

void require_same_size(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error(ErrorCode::input, "",
                fmt::format("the images differ in size (got {} x {} and {} x {})", image.width, image.height,
                            reference.width, reference.height));
}

std::vector<Crop> common_areas(const Image& image, const Image& reference) {
  require_same_size(image, reference);
  const std::vector<Crop> a = recorded_areas(image);
  const std::vector<Crop> b = recorded_areas(reference);
  std::vector<Crop> both;
  for (const Crop& of_image : a)
    for (const Crop& of_reference : b)
      if (const auto common = common_pixels(of_image, of_reference)) both.push_back(*common);
  if (both.empty())
    throw Error(
        ErrorCode::input, "",
        fmt::format("the images have no pixel in common (got crops {} and {})", to_text(a), to_text(b)));
  return both;
}

Image extract_areas(const Image& image, std::span<const Crop> areas) {
  Image cut{areas.front().x1 - areas.front().x0, areas.front().y1 - areas.front().y0, {}, image.metadata};
  if (areas.size() > 1) {
    cut.height = 1;
    cut.width = 0;
    for (const Crop& area : areas) cut.width += static_cast<int>(pixel_count(area));
  }
  for (const char* key : {kCropKey, kAreasKey}) cut.metadata.erase(key);
  for (const ImageChannel& channel : image.channels) {
    std::vector<float>& values = cut.channels.emplace_back(ImageChannel{channel.name, {}}).values;
    values.reserve(cut.pixels());
    for (const Crop& area : areas)
      for (int y = area.y0; y < area.y1; ++y) {
        const auto row = channel.values.begin() + static_cast<std::ptrdiff_t>(y) * image.width;
        values.insert(values.end(), row + area.x0, row + area.x1);
      }
  }
  return cut;
}

}  // namespace abbe

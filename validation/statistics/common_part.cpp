#include "validation/statistics/common_part.h"

#include <algorithm>

#include <fmt/format.h>

#include "sensor/film/recorded_crop.h"

namespace abbe {

void require_same_size(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error(ErrorCode::input, "",
                fmt::format("the images differ in size (got {} x {} and {} x {})", image.width, image.height,
                            reference.width, reference.height));
}

Crop common_part(const Image& image, const Image& reference) {
  require_same_size(image, reference);
  const Crop all{0, 0, image.width, image.height};
  const Crop a = recorded_crop(image).value_or(all);
  const Crop b = recorded_crop(reference).value_or(all);
  const Crop both{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  if (both.x0 >= both.x1 || both.y0 >= both.y1)
    throw Error(
        ErrorCode::input, "",
        fmt::format("the images have no pixel in common (got crops {} and {})", to_text(a), to_text(b)));
  return both;
}

Image part_of(const Image& image, const Crop& part) {
  Image cut{part.x1 - part.x0, part.y1 - part.y0, {}, image.metadata};
  cut.metadata.erase(kCropKey);
  for (const ImageChannel& channel : image.channels) {
    ImageChannel& values = cut.channels.emplace_back(ImageChannel{channel.name, {}});
    values.values.reserve(cut.pixels());
    for (int y = part.y0; y < part.y1; ++y) {
      const auto row = channel.values.begin() + static_cast<std::ptrdiff_t>(y) * image.width;
      values.values.insert(values.values.end(), row + part.x0, row + part.x1);
    }
  }
  return cut;
}

}  // namespace abbe

#include "materials/texture/texture_image.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/error.h"

namespace abbe {

namespace {

/// Two neighbouring texels along an axis, and the weight of the second.
struct Neighbours {
  std::array<std::size_t, 2> index;
  float second;
};

// The texel of a whole number `index` along an axis of `count` texels, by the rule outside the edges.
std::size_t wrapped(double index, double count, TextureWrap wrap) {
  const double inside = wrap == TextureWrap::repeat ? index - count * std::floor(index / count)
                                                    : std::clamp(index, 0.0, count - 1);
  return static_cast<std::size_t>(std::min(inside, count - 1));  // rounding may give the count itself
}

// `x` runs from 0 to 1 between the edges of the image.
Neighbours neighbours(double x, std::size_t size, const TextureMapping& mapping) {
  const auto count = static_cast<double>(size);
  if (mapping.filter == TextureFilter::nearest) {
    const std::size_t nearest = wrapped(std::floor(x * count), count, mapping.wrap);
    return {{nearest, nearest}, 0};
  }
  const double from_center = x * count - 0.5;
  const double first = std::floor(from_center);
  return {{wrapped(first, count, mapping.wrap), wrapped(first + 1, count, mapping.wrap)},
          static_cast<float>(from_center - first)};
}

}  // namespace

TextureImage::TextureImage(std::size_t width, std::size_t height, std::size_t channels,
                           std::vector<float> texels, const TextureMapping& mapping)
    : width_(width), height_(height), channels_(channels), texels_(std::move(texels)), mapping_(mapping) {
  if (texels_.empty() || texels_.size() != width * height * channels)
    throw Error(ErrorCode::internal, "texture", "as many values as texels and channels are needed");
}

Imath::V2d TextureImage::gradient(const Imath::V2f& uv, std::size_t channel) const {
  const Imath::V2d at = on_image(uv);
  const Imath::V2d size(static_cast<double>(width_), static_cast<double>(height_));
  const auto change = [&](const Imath::V2d& half) {
    return static_cast<double>(value(blend_at(at + half), channel)) -
           static_cast<double>(value(blend_at(at - half), channel));
  };
  const Imath::V2d differences(change({0.5 / size.x, 0}), change({0, 0.5 / size.y}));
  return differences * size * mapping_.scale;
}

TextureImage::Blend TextureImage::blend_at(const Imath::V2d& at) const {
  const Neighbours column = neighbours(at.x, width_, mapping_);
  const Neighbours row = neighbours(1 - at.y, height_, mapping_);
  const float right = column.second;
  const float below = row.second;
  const std::size_t above = row.index[0] * width_;
  const std::size_t under = row.index[1] * width_;
  return {
      {above + column.index[0], above + column.index[1], under + column.index[0], under + column.index[1]},
      {(1 - right) * (1 - below), right * (1 - below), (1 - right) * below, right * below}};
}

Imath::V3d NormalMap::normal(const Imath::V2f& uv) const {
  const TextureImage::Blend blend = image.blend(uv);
  const Imath::V3f code(image.value(blend, 0), image.value(blend, 1), image.value(blend, 2));
  return (Imath::V3d(code) * 2 - Imath::V3d(1)).normalized();
}

Imath::V2d BumpMap::slope(const Imath::V2f& uv) const {
  return image.gradient(uv, 0) * height_m;
}

}  // namespace abbe

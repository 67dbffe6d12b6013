#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <ImathVec.h>

namespace abbe {

/// Between texel centres the value is bilinear, or that of the nearest.
enum class TextureFilter { bilinear, nearest };
/// Beyond its edges an image repeats, or holds the values of its edge.
enum class TextureWrap { repeat, clamp };

/// How an image lies on surface coordinates (u, v): at scale * (u, v) + offset, in widths and heights of the
/// image.
struct TextureMapping {
  TextureFilter filter = TextureFilter::bilinear;
  TextureWrap wrap = TextureWrap::repeat;
  Imath::V2d scale{1, 1};
  Imath::V2d offset{0, 0};
};

/// Channels of an image, looked up by surface coordinates. (0, 0) is its lower left corner and (1, 1) its
/// upper right one, as the image is seen; the centre of a texel is half a texel from its edges.
class TextureImage {
 public:
  /// `texels` row by row from the top left, the channels of a texel together. Throws Error{internal} unless
  /// there are width * height * channels of them, and at least one.
  TextureImage(std::size_t width, std::size_t height, std::size_t channels, std::vector<float> texels,
               const TextureMapping& mapping);

  /// The texels that make a value, and their weights, which add up to 1.
  struct Blend {
    std::array<std::size_t, 4> texel;
    std::array<float, 4> weight;
  };
  [[nodiscard]] Blend blend(const Imath::V2f& uv) const { return blend_at(on_image(uv)); }
  [[nodiscard]] float value(const Blend& blend, std::size_t channel) const {
    float sum = 0;
    for (std::size_t i = 0; i < blend.texel.size(); ++i)
      sum += blend.weight[i] * texels_[blend.texel[i] * channels_ + channel];
    return sum;
  }

  /// How a channel changes with u and v: by differences across a texel, which bilinear values make
  /// continuous.
  [[nodiscard]] Imath::V2d gradient(const Imath::V2f& uv, std::size_t channel) const;

  [[nodiscard]] std::size_t channels() const { return channels_; }
  [[nodiscard]] std::size_t memory_bytes() const { return texels_.size() * sizeof(float); }

 private:
  [[nodiscard]] Imath::V2d on_image(const Imath::V2f& uv) const {
    return mapping_.scale * Imath::V2d(uv) + mapping_.offset;
  }
  [[nodiscard]] Blend blend_at(const Imath::V2d& at) const;

  std::size_t width_;
  std::size_t height_;
  std::size_t channels_;
  std::vector<float> texels_;
  TextureMapping mapping_;
};

}  // namespace abbe

#pragma once

#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include <ImathVec.h>

namespace abbe {

/// Interpolation between texel centres, or the value of the `nearest` texel.
enum class TextureFilter { bilinear, nearest };
/// Extension of the image outside its edges: `repeat` tiles it, `clamp` continues the values of the edge.
enum class TextureWrap { repeat, clamp };

/// Position of an image on surface coordinates (u, v): scale * (u, v) + offset, in widths and heights of the
/// image.
struct TextureMapping {
  TextureFilter filter = TextureFilter::bilinear;
  TextureWrap wrap = TextureWrap::repeat;
  Imath::V2d scale{1, 1};
  Imath::V2d offset{0, 0};
};

/// Channels of an image, looked up by surface coordinates (u, v) through a `TextureMapping`. Mapped
/// coordinates (0, 0) are the lower left corner and (1, 1) the upper right corner of the displayed image.
/// Texel centres are half a texel from the edges.
class TextureImage {
 public:
  /// `texels` are in rows from the top left, with the channels of a texel together. Throws Error{internal}
  /// unless there are width * height * channels of them, and at least one.
  TextureImage(std::size_t width, std::size_t height, std::size_t channels, std::vector<float> texels,
               const TextureMapping& mapping);

  /// Numbers of the texels that contribute to a value, in rows from the top left, with weights that sum to 1.
  struct Blend {
    std::array<std::size_t, 4> texel;
    std::array<float, 4> weight;
  };
  [[nodiscard]] Blend blend(const Imath::V2f& uv) const { return blend_at(on_image(uv)); }
  /// Interpolated value of a channel, counted from 0; the channel must exist.
  [[nodiscard]] float value(const Blend& blend, std::size_t channel) const {
    float sum = 0;
    for (std::size_t i = 0; i < blend.texel.size(); ++i)
      sum += blend.weight[i] * texels_[blend.texel[i] * channels_ + channel];
    return sum;
  }

  /// Derivatives of a channel with respect to u and v, from differences across a texel. They are continuous
  /// with bilinear interpolation.
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

/// An image of surface normals. Its first three channels, in [0, 1], encode the components from -1 to 1 along
/// dp/du, along dp/dv ("green is up") and along the outward normal.
struct NormalMap {
  TextureImage image;

  /// The unit normal in these axes.
  [[nodiscard]] Imath::V3d normal(const Imath::V2f& uv) const;
};

/// An image of heights above the surface: `height_m` [m] times its first channel.
struct BumpMap {
  TextureImage image;
  double height_m;

  /// Derivatives of the height [m] with respect to u and v.
  [[nodiscard]] Imath::V2d slope(const Imath::V2f& uv) const;
};

/// A map that perturbs the shading normal. It neither casts shadows nor occludes.
using Relief = std::variant<NormalMap, BumpMap>;

}  // namespace abbe

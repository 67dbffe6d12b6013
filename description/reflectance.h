#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "description/curve.h"
#include "io/image.h"
#include "materials/texture/spectral_texture.h"
#include "materials/texture/texture_image.h"
#include "spectral/rgb.h"

namespace abbe::spec {

/// An image and its mapping onto surfaces.
struct TextureFile {
  schema::Located<std::string> image;
  TextureMapping mapping;
};
[[nodiscard]] schema::Fields fields(schema::Tag<TextureFile>);
/// The spectrum that each channel of an image multiplies.
struct Weights : schema::Located<std::vector<schema::Named<Curve>>> {};
struct Rgb : schema::Located<bool> {};
struct Texture {
  TextureFile file;
  std::variant<std::monostate, Weights, Rgb> of;
};
/// A reflectance in [0, 1]: a function of wavelength, or of wavelength and position on the surface.
using Reflectance = std::variant<Curve, Texture>;
[[nodiscard]] schema::ValueType value_type(schema::Tag<Reflectance>);

}  // namespace abbe::spec

namespace abbe::description {

/// An image named by a scene, and its mapping onto surfaces.
struct TextureFile {
  std::string name;
  SourcePosition where;
  Image image;
  TextureMapping mapping;
  MemoryReservation memory;  ///< Memory of the image.

  /// Reports `what` as an error about this image.
  void refuse(const std::string& what, ErrorCode code, LoadContext& context) const;
  /// Name of texel number `i` for messages: "texel (column, row)", counted from the top left.
  [[nodiscard]] std::string texel_name(std::size_t i) const;
};

/// Reads the image with its first row at the top. Reports an image that cannot be read or is too large.
[[nodiscard]] std::optional<TextureFile> build(const spec::TextureFile& file, LoadContext& context);

/// Reads `channels` of the image, texel by texel, decoded to linear values. Reports a channel that does not
/// exist and a value that is not finite.
[[nodiscard]] std::optional<std::vector<float>> read_texels(const TextureFile& file,
                                                            std::span<const std::string> channels,
                                                            const Encoding& encoding, LoadContext& context);

/// Makes a texture of texels with `channels` values each, with the mapping of `file`.
[[nodiscard]] TextureImage texture_image(const TextureFile& file, std::size_t channels,
                                         std::vector<float> texels);

/// Builds a reflectance. Reports values outside [0, 1], of a curve or a texel; returns nothing after an
/// error.
[[nodiscard]] std::optional<SpectralTexture> build(const spec::Reflectance& reflectance,
                                                   LoadContext& context);

}  // namespace abbe::description

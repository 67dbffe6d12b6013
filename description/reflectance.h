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

/// An image, and how it lies on surfaces.
struct TextureFile {
  schema::Located<std::string> image;
  TextureMapping mapping;
};
[[nodiscard]] schema::Fields fields(schema::Tag<TextureFile>);
/// The spectrum that each channel weighs.
struct Weights : schema::Located<std::vector<schema::Named<Curve>>> {};
struct Rgb : schema::Located<bool> {};
struct Texture {
  TextureFile file;
  std::variant<std::monostate, Weights, Rgb> of;
};
/// A quantity in [0, 1] over wavelength, and perhaps over the surface.
using Reflectance = std::variant<Curve, Texture>;
[[nodiscard]] schema::Kind kind(schema::Tag<Reflectance>);

}  // namespace abbe::spec

namespace abbe::description {

/// An image named by a scene, and how it lies on surfaces.
struct TextureFile {
  std::string name;
  SourcePosition where;
  Image image;
  TextureMapping mapping;
  HeldMemory held;  ///< By the image.

  /// The complaint `what` about this image, as an error of that kind.
  void refuse(const std::string& what, ErrorCode code, LoadContext& context) const;
  /// Where texel number `i` is: "(column, row)" from the top left.
  [[nodiscard]] std::string texel_name(std::size_t i) const;
};

/// The image, read and turned upright; one that cannot be read or is too large is reported.
[[nodiscard]] std::optional<TextureFile> build(const spec::TextureFile& file, LoadContext& context);

/// Reads the linear values of `channels` of the image texel by texel; a channel that is not there and a value
/// that is not finite are reported.
[[nodiscard]] std::optional<std::vector<float>> read_texels(const TextureFile& file,
                                                            std::span<const std::string> channels,
                                                            const Encoding& encoding, LoadContext& context);

/// Makes an image of texels with so many channels each, laid on surfaces as the file says.
[[nodiscard]] TextureImage texture_image(const TextureFile& file, std::size_t channels,
                                         std::vector<float> texels);

/// Reports values beyond [0, 1], of a curve or of a texel.
/// Throws Error{input} or Error{resource} for an image file that cannot be read or is too large.
[[nodiscard]] std::optional<SpectralTexture> build(const spec::Reflectance& reflectance,
                                                   LoadContext& context);

}  // namespace abbe::description

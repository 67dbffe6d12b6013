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
  schema::Located<std::string> image;  ///< Name of the image file.
  TextureMapping mapping;
};
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<TextureFile>);
/// The spectrum that each named channel of an image multiplies; channel values are linear. The reflectance is
/// the sum.
struct Weights : schema::Located<std::vector<schema::Named<Curve>>> {};
/// True: the channels R, G, B are a colour, in the encoding of the file. False is an error.
struct Rgb : schema::Located<bool> {};
/// A reflectance that an image gives.
struct Texture {
  TextureFile file;
  std::variant<std::monostate, Weights, Rgb> of;
};
/// A reflectance in [0, 1]: a function of wavelength, or of wavelength and position on the surface.
using Reflectance = std::variant<Curve, Texture>;
[[nodiscard]] schema::ValueType value_type(schema::Tag<Reflectance>);

}  // namespace abbe::spec

namespace abbe::description {

/// An image that has been read, and its mapping onto surfaces.
struct TextureFile {
  std::string name;      ///< Name in the scene file, for messages.
  SourcePosition where;  ///< Position of that name.
  Image image;
  TextureMapping mapping;
  MemoryReservation memory;  ///< Memory of the image.

  /// Reports `what` as an error about this image, at `where`, to `context.diagnostics`.
  void refuse(const std::string& what, ErrorCode code, LoadContext& context) const;
  /// Name for messages of texel number `i`, row by row: "texel (column, row)", counted from the top left.
  [[nodiscard]] std::string texel_name(std::size_t i) const;
};

// Functions report errors to `context.diagnostics`.

/// Reads the image, rotated so that its first row is at the top. Reports a URL and an image that cannot be
/// read or is too large; returns nothing then.
[[nodiscard]] std::optional<TextureFile> build(const spec::TextureFile& file, LoadContext& context);

/// Values of `channels` of the image, decoded to linear values by `encoding`. The channels of a texel follow
/// each other; texels count row by row from the top left. Reports a channel that does not exist and a value
/// that is not finite, and returns nothing. Throws Error{resource} if the memory limit is exceeded.
[[nodiscard]] std::optional<std::vector<float>> read_texels(const TextureFile& file,
                                                            std::span<const std::string> channels,
                                                            const Encoding& encoding, LoadContext& context);

/// Texture of texels from `read_texels` with `channels` values each, and the size and mapping of `file`.
[[nodiscard]] TextureImage texture_image(const TextureFile& file, std::size_t channels,
                                         std::vector<float> texels);

/// Builds a reflectance; nothing after an error. Reports values outside [0, 1]; those of a texel that exceed
/// it by at most 1e-3 are clamped with a warning. Warns that RGB values do not determine a spectrum. Throws
/// Error{resource} if the memory limit is exceeded.
[[nodiscard]] std::optional<SpectralTexture> build(const spec::Reflectance& reflectance,
                                                   LoadContext& context);

}  // namespace abbe::description

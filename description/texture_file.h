#pragma once

#include <optional>
#include <span>
#include <string>

#include "description/load_context.h"
#include "io/image.h"
#include "io/object_reader.h"
#include "materials/texture/texture_image.h"

namespace abbe::description {

/// How a file's values stand for numbers.
enum class Encoding { linear, srgb };

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

/// The keys all textures have: "image", "filter", "wrap", "scale" and "offset". An image that cannot be read
/// or is too large is reported.
[[nodiscard]] std::optional<TextureFile> read_texture_file(ObjectReader& reader, LoadContext& context);

/// Reads `channels` of the image texel by texel; a channel that is not there and a value that is not finite
/// are reported.
[[nodiscard]] std::optional<std::vector<float>> read_texels(const TextureFile& file,
                                                            std::span<const std::string> channels,
                                                            Encoding encoding, LoadContext& context);

/// Makes an image of texels with so many channels each, laid on surfaces as the file says.
[[nodiscard]] TextureImage texture_image(const TextureFile& file, std::size_t channels,
                                         std::vector<float> texels);

}  // namespace abbe::description

#include "description/reflectance.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "io/picture.h"

namespace abbe::description {
void TextureFile::refuse(const std::string& what, ErrorCode code, LoadContext& context) const {
  context.diagnostics.error(where, fmt::format("texture \"{}\": {}", name, what), code);
}

std::string TextureFile::texel_name(std::size_t i) const {
  const auto columns = static_cast<std::size_t>(image.width);
  return fmt::format("texel ({}, {})", i % columns, i / columns);
}

std::optional<TextureFile> build(const spec::TextureFile& spec, LoadContext& context) {
  const std::string& name = spec.image.value;
  const SourcePosition& where = spec.image.where;
  const auto path = context.file(name, where);
  if (!path) return std::nullopt;
  try {
    Image image = apply_orientation(read_image(*path, context.inputs));
    const std::size_t bytes = image.memory_bytes();
    return TextureFile{name, where, std::move(image), spec.mapping, {context.inputs, bytes}};
  } catch (const Error& e) {
    context.diagnostics.error(where, e.what(), e.code);
    return std::nullopt;
  }
}

std::optional<std::vector<float>> read_texels(const TextureFile& file, std::span<const std::string> channels,
                                              const Encoding& encoding, LoadContext& context) {
  context.take_memory(fmt::format("texture \"{}\"", file.name),
                      file.image.pixels() * channels.size() * sizeof(float));
  std::vector<float> texels(file.image.pixels() * channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const ImageChannel* channel = file.image.find(channels[c]);
    if (channel == nullptr) {
      std::vector<std::string> names;
      for (const ImageChannel& known : file.image.channels) names.push_back(known.name);
      file.refuse(fmt::format("no channel \"{}\" (it has {})", channels[c], fmt::join(names, ", ")),
                  ErrorCode::input, context);
      return std::nullopt;
    }
    for (std::size_t i = 0; i < file.image.pixels(); ++i) {
      const float value = channel->values[i];
      if (!std::isfinite(value)) {
        file.refuse(
            fmt::format("{} of channel {} is not finite (got {})", file.texel_name(i), channel->name, value),
            ErrorCode::input, context);
        return std::nullopt;
      }
      texels[i * channels.size() + c] = static_cast<float>(encoding.decoded(static_cast<double>(value)));
    }
  }
  return texels;
}

TextureImage texture_image(const TextureFile& file, std::size_t channels, std::vector<float> texels) {
  return {static_cast<std::size_t>(file.image.width), static_cast<std::size_t>(file.image.height), channels,
          std::move(texels), file.mapping};
}

}  // namespace abbe::description

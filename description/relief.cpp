#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "description/material.h"

namespace abbe::description {
namespace {

// The image of a map, which must have as many channels as it means something by.
std::optional<TextureImage> map_image(const TextureFile& file, std::span<const std::string> channels,
                                      const char* what, LoadContext& context) {
  if (file.image.channels.size() != channels.size()) {
    file.refuse(
        fmt::format("{} has {} (got {} channels)", what,
                    channels.size() == 1 ? "one channel" : "channels R, G, B", file.image.channels.size()),
        ErrorCode::input, context);
    return std::nullopt;
  }
  auto texels = read_texels(file, channels, kLinearEncoding, context);
  if (!texels) return std::nullopt;
  return texture_image(file, channels.size(), std::move(*texels));
}

}  // namespace

std::shared_ptr<const Relief> build(const spec::NormalMap& said, LoadContext& context) {
  const auto file = build(said.file, context);
  if (!file) return nullptr;
  const std::vector<std::string> channels{"R", "G", "B"};
  auto image = map_image(*file, channels, "a normal map", context);
  if (!image) return nullptr;
  const std::vector<float>& outward = file->image.find(channels[2])->values;
  for (std::size_t i = 0; i < outward.size(); ++i) {
    if (outward[i] > 0.5F) continue;
    file->refuse(fmt::format("{} has a normal that does not point outward (got B = {}, allowed (0.5, 1])",
                             file->texel_name(i), outward[i]),
                 ErrorCode::input, context);
    return nullptr;
  }
  return std::make_shared<const Relief>(NormalMap{std::move(*image)});
}

std::shared_ptr<const Relief> build(const spec::BumpMap& said, LoadContext& context) {
  const auto file = build(said.file, context);
  if (!file) return nullptr;
  const std::vector<std::string> only{file->image.channels.empty() ? "" : file->image.channels[0].name};
  auto image = map_image(*file, only, "a bump map", context);
  if (!image) return nullptr;
  return std::make_shared<const Relief>(BumpMap{std::move(*image), said.height * context.unit_m});
}

}  // namespace abbe::description

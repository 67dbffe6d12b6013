#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "description/material.h"

namespace abbe::description {
namespace {

// The image of a map. Reports an image with another number of channels than the map needs.
std::optional<TextureImage> map_image(const TextureFile& file, std::span<const std::string> channels,
                                      const char* what, LoadContext& context) {
  if (file.image.channels.size() != channels.size()) {
    file.refuse(
        fmt::format("{} needs {} (got {} channels)", what,
                    channels.size() == 1 ? "one channel" : "channels R, G, B", file.image.channels.size()),
        ErrorCode::input, context);
    return std::nullopt;
  }
  auto texels = read_texels(file, channels, kLinearEncoding, context);
  if (!texels) return std::nullopt;
  return texture_image(file, channels.size(), std::move(*texels));
}

// Reason why texel number `i` is not an outward normal, if it is not.
std::optional<std::string> normal_fault(const TextureFile& file, const std::vector<const ImageChannel*>& rgb,
                                        std::size_t i) {
  constexpr float kRounding = 1e-3F;  // Rounding of filtered values and of half floats.
  for (const ImageChannel* channel : rgb)
    if (const float value = channel->values[i]; value < -kRounding || value > 1 + kRounding)
      return fmt::format("{} is not an encoded normal (got {} = {}, allowed [0, 1])", file.texel_name(i),
                         channel->name, value);
  const float outward = rgb.back()->values[i];
  if (outward > 0.5F) return std::nullopt;
  return fmt::format("{} is a normal that does not point outward (got B = {}, allowed (0.5, 1])",
                     file.texel_name(i), outward);
}

}  // namespace

std::shared_ptr<const Relief> build(const spec::NormalMap& spec, LoadContext& context) {
  const auto file = build(spec.file, context);
  if (!file) return nullptr;
  const std::vector<std::string> channels{"R", "G", "B"};
  auto image = map_image(*file, channels, "a normal map", context);
  if (!image) return nullptr;
  std::vector<const ImageChannel*> rgb;
  for (const std::string& channel : channels) rgb.push_back(file->image.find(channel));
  for (std::size_t i = 0; i < file->image.pixels(); ++i) {
    const auto fault = normal_fault(*file, rgb, i);
    if (!fault) continue;
    file->refuse(*fault, ErrorCode::input, context);
    return nullptr;
  }
  return std::make_shared<const Relief>(NormalMap{std::move(*image)});
}

std::shared_ptr<const Relief> build(const spec::BumpMap& spec, LoadContext& context) {
  const auto file = build(spec.file, context);
  if (!file) return nullptr;
  const std::vector<std::string> only{file->image.channels.empty() ? "" : file->image.channels[0].name};
  auto image = map_image(*file, only, "a bump map", context);
  if (!image) return nullptr;
  return std::make_shared<const Relief>(BumpMap{std::move(*image), spec.height * context.unit_m});
}

}  // namespace abbe::description

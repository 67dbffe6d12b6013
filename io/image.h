#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/error.h"

namespace abbe {

/// One float plane of an image.
struct ImageChannel {
  std::string name;
  std::vector<float> values;  ///< `width * height` values, row by row from the top left.
};

/// Named float channels and metadata. Channel names are unique. Each channel has `pixels()` values.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<ImageChannel> channels;
  std::map<std::string, std::string> metadata;

  /// The channel of that name, case-sensitive; nullptr if there is none.
  [[nodiscard]] const ImageChannel* find(std::string_view name) const {
    for (const ImageChannel& channel : channels)
      if (channel.name == name) return &channel;
    return nullptr;
  }
  /// Memory of the values of all channels [bytes].
  [[nodiscard]] std::size_t memory_bytes() const { return pixels() * channels.size() * sizeof(float); }
  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// Largest image edge and pixel count accepted from any file or scene; checked before allocation.
inline constexpr int kMaxImageEdge = 65536;
inline constexpr std::size_t kMaxImagePixels = std::size_t{1} << 28;
/// Largest memory of all float channels of an image [bytes].
inline constexpr std::size_t kMaxImageBytes = std::size_t{8} << 30;

/// Throws Error{resource}, which names the file or option `where`, if an image of that size exceeds these
/// limits. Callers check before they allocate pixels. Sizes below 1 are accepted.
inline void require_image_size(const std::string& where, std::int64_t width, std::int64_t height,
                               std::size_t channels) {
  if (width > kMaxImageEdge || height > kMaxImageEdge ||
      width * height > static_cast<std::int64_t>(kMaxImagePixels))
    throw Error(ErrorCode::resource, where,
                "image too large (got " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels, allowed edges of " + std::to_string(kMaxImageEdge) + " and " +
                    std::to_string(kMaxImagePixels) + " in all)");
  const std::size_t pixels = static_cast<std::size_t>(width * height);
  if (channels > 0 && pixels > kMaxImageBytes / sizeof(float) / channels)
    throw Error(ErrorCode::resource, where,
                "image too large (got " + std::to_string(channels) + " channels of " +
                    std::to_string(pixels) + " pixels, allowed " + std::to_string(kMaxImageBytes) +
                    " bytes)");
}

/// Positions of red, green and blue in `names`, in that order. A name is "R" or "red", in either case.
/// Nothing unless `names` are exactly one name of each.
[[nodiscard]] inline std::optional<std::array<std::size_t, 3>> rgb_order(std::span<const std::string> names) {
  constexpr std::array<std::string_view, 3> kNames{"red", "green", "blue"};
  constexpr std::size_t kNone = 3;
  std::array<std::size_t, 3> order{kNone, kNone, kNone};
  if (names.size() != order.size()) return std::nullopt;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string lower = names[i];
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    for (std::size_t k = 0; k < kNames.size(); ++k)
      if (lower == kNames[k] || lower == kNames[k].substr(0, 1)) order[k] = i;
  }
  if (std::ranges::count(order, kNone) != 0) return std::nullopt;
  return order;
}

}  // namespace abbe

#pragma once

#include <string>
#include <vector>

#include "io/text.h"

namespace abbe {

/// Attribute with the layers that add up to a film, separated by commas; absent if it has none. Each layer
/// has channels `<layer>.<plane>` in the same file.
inline constexpr const char* kLayersKey = "layers";
/// Prefix of the names of light-group layers.
inline constexpr const char* kLightLayer = "light.";

/// Parses the value of `kLayersKey`: the names of the layers in order.
[[nodiscard]] inline std::vector<std::string> parse_layers(const std::string& text) {
  return split(text, ',');
}

}  // namespace abbe

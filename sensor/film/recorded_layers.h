#pragma once

#include <string>
#include <vector>

#include "io/text.h"

namespace abbe {

/// The key under which a film lists the layers it is the sum of, separated by commas; absent where it has
/// none. Each has channels `<layer>.<plane>` beside the film's.
inline constexpr const char* kLayersKey = "layers";
/// What the names of layers of lights begin with.
inline constexpr const char* kLightLayer = "light.";

/// The layers that this key lists.
[[nodiscard]] inline std::vector<std::string> parse_layers(const std::string& text) {
  return split(text, ',');
}

}  // namespace abbe

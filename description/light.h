#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "description/load_context.h"
#include "scene/lights/environment_image.h"
#include "scene/scene.h"

namespace abbe::description {

void read_lights(const JsonValue& json, LoadContext& context, Scene& scene);
/// Makes `scene.shapes[shape]` emit.
void add_area_light(const JsonValue& emission, bool two_sided, std::uint32_t shape, LoadContext& context,
                    Scene& scene);

/// An environment: nothing but its light, or the texels of an image and which way it faces.
struct Sky {
  int width = 0;
  int height = 0;
  std::vector<std::array<float, 3>> texels = {};
  EnvironmentFrame frame = {{0, 0, 1}, {0, 1, 0}};
};
/// Throws Error{input} or Error{resource} for an image file that cannot be read or is too large.
[[nodiscard]] std::optional<Sky> read_sky(const JsonValue& json, LoadContext& context);

}  // namespace abbe::description

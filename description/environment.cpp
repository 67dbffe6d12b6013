#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "description/light.h"
#include "io/extension.h"
#include "io/orientation.h"
#include "io/picture.h"
#include "spectral/rgb.h"

namespace abbe::description {
namespace {

// The planes of red, green and blue; one plane of luminance, without others that tell colour beside it,
// serves for all three.
std::optional<std::array<const ImageChannel*, 3>> find_planes(const Image& image) {
  const auto plane = [&image](const char* name) { return image.find(name); };
  const bool coloured = plane("X") || plane("Z") || plane("RY") || plane("BY");
  if (plane("Y") && !plane("R") && !coloured) return std::array{plane("Y"), plane("Y"), plane("Y")};
  const std::array planes{plane("R"), plane("G"), plane("B")};
  if (!planes[0] || !planes[1] || !planes[2]) return std::nullopt;
  return planes;
}

}  // namespace

std::optional<Sky> build(const spec::Sky& said, LoadContext& context) {
  const auto* picture = std::get_if<spec::SkyImage>(&said.image);
  if (picture == nullptr) return Sky{};
  const std::string& name = picture->file.value;
  const SourcePosition& where = picture->file.where;
  const auto path = context.file(name, where);
  if (!path) return std::nullopt;
  const auto refuse = [&](const std::string& what) {
    context.diagnostics.error(where, fmt::format("environment \"{}\": {}", name, what), ErrorCode::input);
    return std::nullopt;
  };
  const std::string extension = extension_of(*path);
  if (extension != ".exr" && extension != ".hdr")
    return refuse(
        fmt::format("linear values are needed (got \"{}\", allowed .exr, .hdr)", path->extension().string()));
  const Image image = upright(read_image(*path, context.inputs));
  const HeldMemory held(context.inputs, image.memory_bytes());
  const auto planes = find_planes(image);
  if (!planes) return refuse("no channels R, G, B, or Y alone");
  if (const auto fault = rec709_fault(image)) return refuse(*fault);
  // Texels, and the cumulative distribution by which they are drawn.
  context.take_memory(path->string(), image.pixels() * (sizeof(std::array<float, 3>) + sizeof(double)));
  Sky sky{image.width, image.height, std::vector<std::array<float, 3>>(image.pixels()),
          environment_frame(picture->up.normalized(), picture->rotate_deg)};
  std::size_t negative = 0;
  for (std::size_t i = 0; i < image.pixels(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = (*planes)[c]->values[i];
      if (!spec::kPower.contains(std::abs(static_cast<double>(value))))
        return refuse(fmt::format("texel ({}, {}) (got {}, allowed {})",
                                  i % static_cast<std::size_t>(image.width),
                                  i / static_cast<std::size_t>(image.width), value, spec::kPower.text()));
      const bool is_repeated = c > 0 && (*planes)[c] == (*planes)[0];  // a luminance, which is all three
      negative += value < 0 && !is_repeated;
      sky.texels[i][c] = std::max(value, 0.0F);
    }
  if (std::all_of(sky.texels.begin(), sky.texels.end(),
                  [](const std::array<float, 3>& texel) { return texel == std::array<float, 3>{}; }))
    context.diagnostics.error_if_strict(where, fmt::format("environment \"{}\" is black everywhere", name));
  if (negative > 0)
    context.diagnostics.warning(
        where, fmt::format("environment \"{}\": negative values taken as 0: {}", name, negative));
  return sky;
}

}  // namespace abbe::description

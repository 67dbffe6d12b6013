#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "description/light.h"
#include "io/picture.h"
#include "io/text.h"
#include "spectral/rgb.h"

namespace abbe::description {
namespace {

// The planes of red, green and blue. A single luminance plane Y, without planes that would give colour, is
// used for all three.
std::optional<std::array<const ImageChannel*, 3>> find_planes(const Image& image) {
  const auto plane = [&image](const char* name) { return image.find(name); };
  const bool coloured = plane("X") || plane("Z") || plane("RY") || plane("BY");
  if (plane("Y") && !plane("R") && !coloured) return std::array{plane("Y"), plane("Y"), plane("Y")};
  const std::array planes{plane("R"), plane("G"), plane("B")};
  if (!planes[0] || !planes[1] || !planes[2]) return std::nullopt;
  return planes;
}

}  // namespace

std::optional<EnvironmentTexels> build(const spec::EnvironmentLight& spec, LoadContext& context) {
  const auto* image_spec = std::get_if<spec::EnvironmentImage>(&spec.image);
  if (image_spec == nullptr) return EnvironmentTexels{};
  const std::string& name = image_spec->file.value;
  const SourcePosition& where = image_spec->file.where;
  const auto path = context.file(name, where);
  if (!path) return std::nullopt;
  const auto refuse = [&](const std::string& what) {
    return context.refuse(where, fmt::format("environment \"{}\": {}", name, what), ErrorCode::input);
  };
  const std::string extension = extension_of(*path);
  if (extension != ".exr" && extension != ".hdr")
    return refuse(
        fmt::format("linear values are needed (got \"{}\", allowed .exr, .hdr)", path->extension().string()));
  const Image image = apply_orientation(read_image(*path, context.inputs));
  const MemoryReservation memory(context.inputs, image.memory_bytes());
  const auto planes = find_planes(image);
  if (!planes) return refuse("the image needs channels R, G and B, or only Y");
  if (const auto fault = rec709_fault(image)) return refuse(*fault);
  // Memory of the texels and of the cumulative distribution from which they are sampled.
  context.take_memory(path->string(), image.pixels() * (sizeof(std::array<float, 3>) + sizeof(double)));
  EnvironmentTexels environment{image.width, image.height, std::vector<std::array<float, 3>>(image.pixels()),
                                environment_frame(image_spec->up.normalized(), image_spec->rotate_deg)};
  std::size_t negative = 0;
  for (std::size_t i = 0; i < image.pixels(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = (*planes)[c]->values[i];
      if (!spec::kPower.contains(std::abs(static_cast<double>(value))))
        return refuse(fmt::format("texel ({}, {}) (got {}, allowed {})",
                                  i % static_cast<std::size_t>(image.width),
                                  i / static_cast<std::size_t>(image.width), value, spec::kPower.text()));
      const bool is_repeated =
          c > 0 && (*planes)[c] == (*planes)[0];  // A luminance is used for all three channels.
      negative += value < 0 && !is_repeated;
      environment.texels[i][c] = std::max(value, 0.0F);
    }
  if (std::all_of(environment.texels.begin(), environment.texels.end(),
                  [](const std::array<float, 3>& texel) { return texel == std::array<float, 3>{}; }))
    context.diagnostics.error_if_strict(where, fmt::format("environment \"{}\" is black everywhere", name));
  if (negative > 0)
    context.diagnostics.warning(
        where, fmt::format("environment \"{}\": negative values set to 0: {}", name, negative));
  return environment;
}

}  // namespace abbe::description

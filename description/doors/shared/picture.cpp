#include "description/doors/shared/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "io/extension.h"
#include "io/picture.h"

namespace abbe::doors {
namespace {

// Nothing if a value is not finite.
std::optional<double> mean(const ImageChannel& channel, const Encoding& encoding) {
  double sum = 0;
  for (const float value : channel.values) {
    if (!std::isfinite(value)) return std::nullopt;
    sum += encoding.decoded(std::max(static_cast<double>(value), 0.0));
  }
  return sum / static_cast<double>(channel.values.size());
}

std::optional<LinearRgb> mean_of(const Image& image, const Encoding& encoding, const SourcePosition& where,
                                 Door& door) {
  constexpr std::array<std::string_view, 3> kNames{"R", "G", "B"};
  const auto refuse = [&](const std::string& what) {
    door.diagnostics.error(where, what, ErrorCode::input);
    return std::nullopt;
  };
  LinearRgb colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const ImageChannel* channel = image.find(image.find("R") ? kNames.at(c) : "Y");
    if (channel == nullptr) return refuse("the image has no channels R, G, B or Y");
    const auto value = mean(*channel, encoding);
    if (!value) return refuse("the image holds values that are not finite");
    colour.at(c) = *value;
  }
  return colour;
}

}  // namespace

bool holds_codes(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 3> kOfFloats{".exr", ".hdr", ".pfm"};
  return std::ranges::find(kOfFloats, extension_of(file)) == kOfFloats.end();
}

std::optional<LinearRgb> colour_for_refused(const std::filesystem::path& file, const SourcePosition& where,
                                            Door& door) {
  try {
    const Image image = read_image(file, door.inputs);
    const HeldMemory held(door.inputs, image.memory_bytes());
    if (const auto fault = rec709_fault(image)) {
      door.note(where,
                "all images count as sRGB there; here one is an error, and its mean as sRGB stands for it: " +
                    *fault);
      return mean_of(image, Encoding{}, where, door);
    }
    if (recorded_encoding(image).value_or(Encoding{}).gamma)
      door.note(where, "an image is decoded as it says here, and as sRGB there");
  } catch (const Error& fault) {
    door.diagnostics.error(where, fault.what(), fault.code);
  }
  return std::nullopt;
}

std::optional<LinearRgb> mean_colour(const std::filesystem::path& file, const SourcePosition& where,
                                     Door& door) {
  if (!door.take_file(file, where)) return std::nullopt;
  try {
    const Image image = read_image(file, door.inputs);
    if (const auto fault = rec709_fault(image)) {
      door.diagnostics.error(where, *fault, ErrorCode::input);
      return std::nullopt;
    }
    return mean_of(image, recorded_encoding(image).value_or(Encoding{}), where, door);
  } catch (const Error& fault) {
    door.diagnostics.error(where, fault.what(), fault.code);
    return std::nullopt;
  }
}

}  // namespace abbe::doors

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

}  // namespace

bool holds_codes(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 3> kOfFloats{".exr", ".hdr", ".pfm"};
  return std::ranges::find(kOfFloats, extension_of(file)) == kOfFloats.end();
}

std::optional<LinearRgb> mean_colour(const std::filesystem::path& file, const SourcePosition& where,
                                     Door& door) {
  if (!door.take_file(file, where)) return std::nullopt;
  const auto refuse = [&](const std::string& what, ErrorCode code) {
    door.diagnostics.error(where, what, code);
    return std::nullopt;
  };
  try {
    const Image image = read_image(file, door.inputs);
    if (const auto fault = rec709_fault(image)) return refuse(*fault, ErrorCode::input);
    const Encoding encoding = recorded_encoding(image).value_or(Encoding{});
    LinearRgb colour{};
    for (std::size_t c = 0; c < 3; ++c) {
      constexpr std::array<std::string_view, 3> kNames{"R", "G", "B"};
      const ImageChannel* channel = image.find(image.find("R") ? kNames.at(c) : "Y");
      if (channel == nullptr) return refuse("the image has no channels R, G, B or Y", ErrorCode::input);
      const auto value = mean(*channel, encoding);
      if (!value) return refuse("the image holds values that are not finite", ErrorCode::input);
      colour.at(c) = *value;
    }
    return colour;
  } catch (const Error& fault) {
    return refuse(fault.what(), fault.code);
  }
}

}  // namespace abbe::doors

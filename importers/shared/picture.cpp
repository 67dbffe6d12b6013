#include "importers/shared/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "io/picture.h"
#include "io/text.h"

namespace abbe::importers {
namespace {

// Mean of the decoded values. Nothing if a value is not finite.
std::optional<double> mean(const ImageChannel& channel, const Encoding& encoding) {
  double sum = 0;
  for (const float value : channel.values) {
    if (!std::isfinite(value)) return std::nullopt;
    sum += encoding.decoded(std::max(static_cast<double>(value), 0.0));
  }
  return sum / static_cast<double>(channel.values.size());
}

std::optional<LinearRgb> mean_of(const Image& image, const Encoding& encoding, const SourcePosition& where,
                                 SceneImporter& importer) {
  constexpr std::array<std::string_view, 3> kNames{"R", "G", "B"};
  const auto refuse = [&](const std::string& what) {
    importer.diagnostics.error(where, what, ErrorCode::input);
    return std::nullopt;
  };
  LinearRgb colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const ImageChannel* channel = image.find(image.find("R") ? kNames.at(c) : "Y");
    if (channel == nullptr) return refuse("the image has no channels R, G, B or Y");
    const auto value = mean(*channel, encoding);
    if (!value) return refuse("the image has values that are not finite");
    colour.at(c) = *value;
  }
  return colour;
}

}  // namespace

bool holds_codes(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 3> kOfFloats{".exr", ".hdr", ".pfm"};
  return std::ranges::find(kOfFloats, extension_of(file)) == kOfFloats.end();
}

std::optional<LinearRgb> colour_of_rejected_image(const std::filesystem::path& file,
                                                  const SourcePosition& where, SceneImporter& importer) {
  try {
    const Image image = read_image(file, importer.inputs);
    const MemoryReservation reservation(importer.inputs, image.memory_bytes());
    if (const auto fault = rec709_fault(image)) {
      importer.note(where,
                    "an image that Abbe rejects is replaced by its mean as sRGB, as which the source "
                    "renderer takes all images: " +
                        *fault);
      return mean_of(image, Encoding{}, where, importer);
    }
    if (recorded_encoding(image).value_or(Encoding{}).gamma)
      importer.note(where, "an image is decoded as it declares: the source renderer takes it as sRGB");
  } catch (const Error& fault) {
    importer.diagnostics.error(where, fault.what(), fault.code);
  }
  return std::nullopt;
}

std::optional<LinearRgb> mean_colour(const std::filesystem::path& file, const SourcePosition& where,
                                     SceneImporter& importer) {
  if (!importer.check_file(file, where)) return std::nullopt;
  try {
    const Image image = read_image(file, importer.inputs);
    if (const auto fault = rec709_fault(image)) {
      importer.diagnostics.error(where, *fault, ErrorCode::input);
      return std::nullopt;
    }
    return mean_of(image, recorded_encoding(image).value_or(Encoding{}), where, importer);
  } catch (const Error& fault) {
    importer.diagnostics.error(where, fault.what(), fault.code);
    return std::nullopt;
  }
}

}  // namespace abbe::importers

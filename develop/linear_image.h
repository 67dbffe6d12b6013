#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "io/inputs.h"
#include "sensor/film/patch.h"

namespace abbe {

/// An image of any kind, ready to be measured.
struct LinearImage {
  Image image;
  std::vector<std::string> channels;
  std::optional<Mosaic> mosaic;      ///< Then the image has one plane.
  std::optional<double> saturation;  ///< Rounded to single precision, as the values are.
  std::string unit;                  ///< What the values are, in words.
  /// The planes as they were exposed, where opcodes of a DNG or a flat have changed them; empty where nothing
  /// has.
  std::vector<ImageChannel> exposed = {};
  std::vector<std::string> warnings = {};  ///< About the file, each of which names it.

  [[nodiscard]] MeasuredPlanes planes() const;
  /// The planes that decide which pixels are saturated.
  [[nodiscard]] const std::vector<ImageChannel>& as_exposed() const {
    return exposed.empty() ? image.channels : exposed;
  }
  [[nodiscard]] std::size_t memory_bytes() const { return image.memory_bytes() * (exposed.empty() ? 1 : 2); }
};

/// Reads a film (its expected exposure), a spectral film (its bands) or any other picture (its code values in
/// [0, 1], linear or not). A raw DNG, FITS, TIFF or PNG gives digital numbers above black, scaled as the file
/// declares and after the opcodes of a DNG. Throws Error{input} and Error{resource}.
[[nodiscard]] LinearImage read_linear_image(const std::filesystem::path& path, Inputs* inputs = nullptr);

/// Divides each pixel by what a picture of an even surface has there, relative to the mean of its channel: so
/// that neither vignetting nor pixels of unequal sensitivity are taken for colours. Throws Error{input}
/// naming `path` for a flat of other pixels, channels or mosaic, for one with a pixel that is not positive,
/// and for one of whose pixels more than a hundredth are saturated.
void flat_field(LinearImage& image, const LinearImage& flat, const std::filesystem::path& path);

}  // namespace abbe

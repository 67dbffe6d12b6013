#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "io/inputs.h"
#include "sensor/film/patch.h"

namespace abbe {

/// An image from any kind of file, with linear values ready for measurement where the file allows it.
struct LinearImage {
  Image image;
  std::vector<std::string> channels;
  std::optional<Mosaic> mosaic;      ///< If present, the image has one plane.
  std::optional<double> saturation;  ///< Rounded to single precision, like the values.
  std::string unit;                  ///< Description of the values' unit.
  /// The planes as exposed, if opcodes of a DNG or a flat field have changed them; else empty.
  std::vector<ImageChannel> exposed = {};
  std::vector<std::string> warnings = {};  ///< Warnings about the file; each names it.

  /// The planes for measuring patches; they refer to this image.
  [[nodiscard]] MeasuredPlanes planes() const;
  /// The planes that determine which pixels are saturated.
  [[nodiscard]] const std::vector<ImageChannel>& as_exposed() const {
    return exposed.empty() ? image.channels : exposed;
  }
  [[nodiscard]] std::size_t memory_bytes() const { return image.memory_bytes() * (exposed.empty() ? 1 : 2); }
};

/// Reads a film (its expected exposure), a spectral film (its bands) or any other picture (its code values in
/// [0, 1], linear or not). A raw DNG, FITS, TIFF or PNG gives digital numbers above black, scaled as the file
/// declares and after the opcodes of a DNG. Throws Error{input} and Error{resource}.
[[nodiscard]] LinearImage read_linear_image(const std::filesystem::path& path, Inputs* inputs = nullptr);

/// Divides each pixel by that of a picture of a uniform surface, relative to the mean of its channel. This
/// removes vignetting and differences in sensitivity between pixels. Throws Error{input} naming `path` if the
/// size, channels or mosaic of the flat differ. Also throws it for a pixel that is not positive, and for more
/// than 1 % saturated pixels.
void flat_field(LinearImage& image, const LinearImage& flat, const std::filesystem::path& path);

}  // namespace abbe

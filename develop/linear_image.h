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
  std::vector<std::string> channels;  ///< Names of the planes or, with a mosaic, of its channels.
  std::optional<Mosaic> mosaic;       ///< If present, the image has one plane.
  /// Value of `as_exposed` from which on a pixel is saturated, in single precision like the values; nothing
  /// for films.
  std::optional<double> saturation;
  std::string unit;
  /// The planes as exposed, if opcodes of a DNG or a flat field have changed them; else empty.
  std::vector<ImageChannel> exposed = {};
  std::vector<std::string> warnings = {};  ///< Warnings about the file; each names it.

  /// The planes for measuring patches; they refer to this image, which must outlive them.
  [[nodiscard]] MeasuredPlanes planes() const;
  /// The planes that determine which pixels are saturated: `exposed`, or those of the image if that is empty.
  [[nodiscard]] const std::vector<ImageChannel>& as_exposed() const {
    return exposed.empty() ? image.channels : exposed;
  }
  [[nodiscard]] std::size_t memory_bytes() const { return image.memory_bytes() * (exposed.empty() ? 1 : 2); }
};

/// Reads a film (its expected exposure), a spectral film (its bands) or any other picture (its code values in
/// [0, 1], linear or not). A raw DNG, FITS, TIFF or PNG gives digital numbers above black, scaled as the file
/// declares and after the opcodes of a DNG. Throws Error{input} if the file cannot be read, is damaged or has
/// values that are not finite. Throws Error{resource} above the limits of `io/image.h` or of `inputs`.
[[nodiscard]] LinearImage read_linear_image(const std::filesystem::path& path, Inputs* inputs = nullptr);

/// Divides each pixel of `image` by that of `flat`, a picture of a uniform surface, relative to the mean of
/// its channel in `flat`. `exposed` of the image then holds its planes before. This removes vignetting and
/// differences in sensitivity between pixels. Throws Error{input}, which names `path` of the flat, in these
/// cases, and leaves the image unchanged:
/// - its size, channels or mosaic differ from those of the image;
/// - one of its pixels is not above 0;
/// - more of its pixels are saturated than count as defective (`exceeds_defects`).
void flat_field(LinearImage& image, const LinearImage& flat, const std::filesystem::path& path);

}  // namespace abbe

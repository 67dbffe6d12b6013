#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "spectral/colorimetry.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Interpretation of an image's colours.
struct FilmColors {
  std::vector<std::string> channels;  ///< Names of the three channels; the image may lack some.
  /// Matrix from the channels, in their order, to XYZ in the scale of the image; nothing if the colours are
  /// unknown.
  std::optional<Matrix3> to_xyz;
  bool adapted = false;  ///< True if XYZ are adapted from the film's white to D65.
  /// White that the image records, else the white of its recorded primaries. Nothing if it records neither.
  std::optional<Chromaticity> white;
};

/// Determines how the channels of an image are converted to XYZ.
/// - X, Y, Z are tristimulus values, unless `channel.X` records another quantity than a photometric one.
/// - R, G, B with the attribute `channel.R`, and such other X, Y, Z, are sensor channels. The film's matrix
///   `to_xyz_d65` applies, in the order of `sensor_channels`, or of `mosaic_channels` under a mosaic. Without
///   a readable matrix the colours are unknown.
/// - R, G, B of any other image are linear, with the primaries that it records (`recorded_primaries`) or
///   those of Rec.709.
/// Throws Error{input} if the recorded white is malformed.
[[nodiscard]] FilmColors film_colors(const Image& image);

}  // namespace abbe

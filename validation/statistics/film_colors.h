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
  std::optional<Matrix3> to_xyz;      ///< Matrix from the channels to XYZ; empty if unknown.
  bool adapted = false;               ///< True if XYZ are adapted from the film's white to D65.
  std::optional<Chromaticity> white;  ///< Reference white that the film records.
};

/// Determines how the channels of an image are converted to XYZ.
/// - X, Y, Z are tristimulus values, unless `channel.X` records another quantity than a photometric one.
/// - R, G, B with the attribute `channel.R`, and such other X, Y, Z, are sensor channels. The film's matrix
///   `to_xyz_d65` applies, in the order of `sensor_channels`, or of `mosaic_channels` under a mosaic. Without
///   a readable matrix the colours are unknown.
/// - R, G, B of any other image are linear, with the primaries that it records (`recorded_primaries`) or
///   those of Rec.709.
[[nodiscard]] FilmColors film_colors(const Image& image);

}  // namespace abbe

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "spectral/colorimetry.h"
#include "spectral/matrix3.h"

namespace abbe {

/// How the colours of an image are read.
struct FilmColors {
  std::vector<std::string> channels;  ///< Three of them; the image may lack some.
  std::optional<Matrix3> to_xyz;      ///< From their values; nothing where nobody knows.
  bool adapted = false;               ///< XYZ relative to D65 for the film's white.
  std::optional<Chromaticity> white;  ///< What the film tells to be white.
};

/// X, Y, Z are the observer's, unless `channel.X` tells that they count anything but photometric values.
/// Those, and R, G, B of a sensor, which its film tells by `channel.R`, go by the film's own matrix
/// `to_xyz_d65`, in the order of `sensor_channels`, or of `mosaic_channels` under a mosaic; without one that
/// can be read, nothing is known of their colours. R, G, B of any other image are linear, of the primaries it
/// tells (`recorded_primaries`) or of Rec.709.
[[nodiscard]] FilmColors film_colors(const Image& image);

}  // namespace abbe

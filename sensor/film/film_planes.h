#pragma once

#include <string>
#include <vector>

#include "io/image.h"

namespace abbe {

/// Names of the main planes in the image of a film's file, without variances, layers and features. Throws
/// Error{input} for a malformed name of a spectral band. The planes are
/// - of a spectral film its bands, by Stokes component and wavelength;
/// - otherwise those that the attribute `sensor_channels` lists, in its order;
/// - without that attribute all channels except variances, in the order of the file.
[[nodiscard]] std::vector<std::string> plane_names(const Image& film);

/// True unless the film declares a unit of X, Y and Z that is not photometric, so that they are no
/// tristimulus values.
[[nodiscard]] bool may_hold_tristimulus_values(const Image& film);

}  // namespace abbe

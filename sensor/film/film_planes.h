#pragma once

#include <string>
#include <vector>

#include "io/image.h"

namespace abbe {

/// The names of the planes of a film's file, without what stands beside them, such as variances, layers and
/// features of the first surface: of a spectral film its bands by Stokes component and wavelength, of another
/// what `sensor_channels` lists, in that order, and of any other image all channels that are no variances, in
/// the order of the file. Throws Error{input} for a name that begins as a spectral one and is none.
[[nodiscard]] std::vector<std::string> plane_names(const Image& film);

/// Whether X, Y, Z may be tristimulus values: those that are not, their film tells to be of another unit.
[[nodiscard]] bool tells_tristimulus_values(const Image& film);

}  // namespace abbe

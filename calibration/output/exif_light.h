#pragma once

#include <string>

#include "spectral/colorimetry.h"

namespace abbe {

/// The number among the light sources of Exif [Exif] of the illuminant that the data folder has by this name,
/// aliases included: A, B, C, D50, D55, D65, D75, or a fluorescent lamp of the CIE (FL1, F1, FL3.7 ...) by
/// the colour temperatures that Exif gives its kinds. 255, another light, for any other name, and for tables
/// of users whatever they are called.
[[nodiscard]] int exif_light_source(const std::string& name);

/// The same of a light that is known by its chromaticity alone: that of the illuminant with this chromaticity
/// to 0.0005, standard ones before FL1 to FL12.
[[nodiscard]] int exif_light_source(const Chromaticity& white);

}  // namespace abbe

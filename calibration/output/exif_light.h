#pragma once

#include <string>

#include "spectral/colorimetry.h"

namespace abbe {

/// Exif light source number [Exif] of an illuminant by its name in the data directory, aliases included. It
/// knows A, B, C, D50, D55, D65, D75 and the CIE's fluorescent lights (FL1, F1, FL3.7 ...), which Exif
/// classifies by colour temperature. Other names, and all tables of users, give 255 (other light).
[[nodiscard]] int exif_light_source(const std::string& name);

/// Exif light source number of a light with a known chromaticity only: that of the illuminant with this
/// chromaticity to 0.0005, 255 if there is none. Standard illuminants are tried first, then FL1 to FL12.
[[nodiscard]] int exif_light_source(const Chromaticity& white);

}  // namespace abbe

#pragma once

#include <array>
#include <optional>

#include "calibration/chart/matrix3.h"
#include "spectral/colorimetry.h"
#include "spectral/rgb.h"

namespace abbe {

/// CIE 1931 chromaticity coordinates.
using Chromaticity = std::array<double, 2>;

/// XYZ of a chromaticity with Y = 1.
[[nodiscard]] XYZ unit_xyz(const Chromaticity& xy);

/// The white of sRGB displays and of Rec.709: D65 as those standards print it.
inline constexpr Chromaticity kD65{0.3127, 0.3290};

/// An RGB space: the chromaticities of its primaries and of its white.
struct RgbSpace {
  Chromaticity red;
  Chromaticity green;
  Chromaticity blue;
  Chromaticity white;
};
inline constexpr RgbSpace kRec709{kRec709Primaries[0], kRec709Primaries[1], kRec709Primaries[2],
                                  kD65};  ///< [BT709]
inline constexpr RgbSpace kAces2065{
    {0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, {0.32168, 0.33767}};  ///< [ST2065-1]

/// Linear RGB to XYZ, such that (1, 1, 1) is the white with Y = 1 [Lindbloom].
[[nodiscard]] Matrix3 rgb_to_xyz(const RgbSpace& space);

/// Chromatic adaptation of XYZ from one white to another in the sharpened Bradford cone space, linear
/// [Lam1985]. Nothing for a white without a positive response of every cone, such as a spectral line.
[[nodiscard]] std::optional<Matrix3> bradford(const XYZ& from_white, const XYZ& to_white);

}  // namespace abbe

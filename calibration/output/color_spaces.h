#pragma once

#include <array>
#include <limits>
#include <optional>

#include "spectral/colorimetry.h"
#include "spectral/matrix3.h"
#include "spectral/rgb.h"

namespace abbe {

/// White of the ACES spaces, near D60 [ST2065-1].
inline constexpr Chromaticity kAcesWhite{0.32168, 0.33767};
inline constexpr RgbSpace kAces2065{
    {0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, kAcesWhite};  ///< AP0 [ST2065-1]
inline constexpr RgbSpace kAcesCg{
    {0.713, 0.293}, {0.165, 0.83}, {0.128, 0.044}, kAcesWhite};                          ///< AP1 [S2014-004]
inline constexpr RgbSpace kP3D65{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kD65};  ///< [RP431-2]

inline constexpr RgbSpace kRec2020{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kD65};  ///< [BT2020]

/// Cone spaces for chromatic adaptation, which multiplies each cone by a gain.
enum class Adaptation {
  bradford,  ///< Sharpened Bradford cones, linear [Lam1985].
  cat02,     ///< The cones of CIECAM02 [CIE159].
  cat16,     ///< The cones of CAM16 [Li2017].
};

/// Matrix from XYZ to the cone responses of a method.
[[nodiscard]] Matrix3 cone_responses(Adaptation method);

/// Matrix of complete chromatic adaptation: it converts XYZ under the white `from_white` to XYZ under
/// `to_white`, and one white to the other. Empty for a white without a positive response of every cone, such
/// as a spectral line.
[[nodiscard]] std::optional<Matrix3> adaptation(const XYZ& from_white, const XYZ& to_white,
                                                Adaptation method = Adaptation::bradford);

/// True if two chromaticities are those of one white: they differ by less than 0.0005, the rounding of tables
/// of illuminants.
[[nodiscard]] bool is_same_white(const Chromaticity& a, const Chromaticity& b);

/// Matrix from linear RGB of a space to XYZ relative to D65, with Bradford adaptation if its white is
/// another. RGB (1, 1, 1) becomes D65 with Y = 1.
[[nodiscard]] Matrix3 rgb_to_xyz_d65(const RgbSpace& space);

/// Gamut of a display or a view: linear RGB of `space` from 0 to `top`, which is infinite by default.
struct Gamut {
  explicit Gamut(const RgbSpace& space, double top = std::numeric_limits<double>::infinity());

  Matrix3 to_xyz_d65;               ///< Converts linear RGB to XYZ relative to D65 (`rgb_to_xyz_d65`).
  Matrix3 from_xyz_d65;             ///< Inverse of `to_xyz_d65`.
  std::array<double, 3> luminance;  ///< Luminances of the primaries, which add up to 1.
  double top;                       ///< Largest value of a primary.
};

/// A colour mapped into a gamut.
struct MappedColor {
  std::array<double, 3> rgb{};  ///< Linear RGB from 0 to `top`.
  /// True if a primary was below zero by more than rounding: the display cannot show such a colour.
  bool outside = false;
  /// True if a primary still exceeded `top` by more than rounding, or if a value was not finite.
  bool too_bright = false;
};

/// Maps linear RGB into the gamut. A colour with a negative primary moves on the straight line towards the
/// grey of its own luminance, only as far as necessary. Luminance is preserved, and so is hue, as the
/// direction from white in the chromaticity diagram. A colour without positive luminance becomes black, and
/// so does one that is not finite. A colour that is then too bright is dimmed at constant chromaticity.
[[nodiscard]] MappedColor map_into(const Gamut& gamut, const std::array<double, 3>& rgb);

}  // namespace abbe

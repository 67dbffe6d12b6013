#pragma once

#include <array>
#include <optional>
#include <string>

#include "io/image.h"
#include "spectral/colorimetry.h"
#include "spectral/curve.h"
#include "spectral/matrix3.h"

namespace abbe {

/// A linear colour in the primaries of Rec.709 and sRGB; (1, 1, 1) is the perfect diffuser under D65.
using LinearRgb = std::array<double, 3>;

/// Chromaticities of those primaries [BT709].
inline constexpr std::array<std::array<double, 2>, 3> kRec709Primaries{
    {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}};

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

/// The space of the R, G and B of an image by its attribute `kPrimariesKey`; nothing where it tells none, or
/// anything but numbers.
[[nodiscard]] std::optional<RgbSpace> recorded_primaries(const Image& image);
/// A space as that attribute tells it.
[[nodiscard]] std::string primaries_text(const RgbSpace& space);
/// Why R, G and B of an image cannot be taken as those of Rec.709, by what it tells of its primaries and its
/// encoding, in its own words or by an ICC profile, which is named then, with its encoding where that is
/// unknown; nothing where it tells no primaries, or these to two digits, and an encoding that is known.
[[nodiscard]] std::optional<std::string> rec709_fault(const Image& image);

/// Linear RGB to XYZ, such that (1, 1, 1) is the white with Y = 1 [Lindbloom].
[[nodiscard]] Matrix3 rgb_to_xyz(const RgbSpace& space);

/// Colour of a reflectance under D65, for the CIE 1931 observer. Its white is that of the shipped table of
/// D65, so that a reflectance of 1 is exactly (1, 1, 1).
[[nodiscard]] LinearRgb linear_rgb(const Curve& reflectance);

/// The linear value in [0, 1] of a code value in [0, 1] encoded as sRGB: x/12.92 up to 0.04045, beyond
/// ((x + 0.055)/1.055)^2.4. [IEC61966, sec. 5.2]
[[nodiscard]] double srgb_decoded(double code);

/// How the values of an image stand for linear ones.
struct Encoding {
  /// The power of a value that is linear, 1 where values are; nothing where they are encoded as sRGB.
  std::optional<double> gamma;

  /// The linear value of one that is 0 or more, or of any where values are linear.
  [[nodiscard]] double decoded(double value) const;
};
inline constexpr Encoding kLinearEncoding{1.0};

/// That of the R, G and B of an image by its attribute `kColorSpace`, sRGB where it tells none; nothing for a
/// space that is unknown.
[[nodiscard]] std::optional<Encoding> recorded_encoding(const Image& image);

/// Three smooth spectra in [0, 1] that add up to 1 everywhere and have the colours (1, 0, 0), (0, 1, 0) and
/// (0, 0, 1) under `linear_rgb`, so that any mixture of them has the colour of its weights, and stays a
/// reflectance while the weights are in [0, 1] [Mallett2019]. Here their logarithms differ by quadratics in
/// wavelength, whose six coefficients the six conditions fix. Beyond 380-780 nm, where the colour determines
/// next to nothing, they are constant. Worked out once. Throws Error{input} when a shipped table is missing.
struct RgbBasis {
  Curve red;
  Curve green;
  Curve blue;
};
[[nodiscard]] const RgbBasis& rgb_basis();

/// The mixture of the basis with the weights `rgb`, each >= 0.
[[nodiscard]] Curve rgb_spectrum(const LinearRgb& rgb);

}  // namespace abbe

#pragma once

#include <array>
#include <optional>
#include <string>

#include "io/image.h"
#include "spectral/colorimetry.h"
#include "spectral/curve.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Linear colour in the primaries of Rec.709 and sRGB; (1, 1, 1) is the perfect diffuser under D65.
using LinearRgb = std::array<double, 3>;

/// XYZ of a chromaticity with Y = 1. Its y must not be 0.
[[nodiscard]] XYZ unit_xyz(const Chromaticity& xy);

/// White of sRGB displays and of Rec.709: D65 as these standards print it.
inline constexpr Chromaticity kD65{0.3127, 0.3290};

/// RGB space: the chromaticities of its primaries and of its white.
struct RgbSpace {
  Chromaticity red;
  Chromaticity green;
  Chromaticity blue;
  Chromaticity white;
};
inline constexpr RgbSpace kRec709{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, kD65};  ///< [BT709]

/// RGB space that an image records in its attribute `kPrimariesKey`; nothing without eight numbers.
[[nodiscard]] std::optional<RgbSpace> recorded_primaries(const Image& image);
/// Text of an RGB space for the attribute `kPrimariesKey`.
[[nodiscard]] std::string primaries_text(const RgbSpace& space);
/// Explains why R, G and B of an image are not those of Rec.709. The image can record its primaries and
/// encoding in attributes or in an ICC profile; the text names the profile, and its encoding if that is
/// unknown. Nothing if the encoding is known, and the primaries are absent or agree to two digits.
[[nodiscard]] std::optional<std::string> rec709_fault(const Image& image);

/// Matrix from linear RGB to XYZ, such that (1, 1, 1) is the white with Y = 1 [Lindbloom]. Throws
/// std::invalid_argument if the primaries lie on one line.
[[nodiscard]] Matrix3 rgb_to_xyz(const RgbSpace& space);

/// Colour of a reflectance under D65 for the CIE 1931 observer. The white is that of the shipped table of
/// D65, so that a reflectance of 1 is exactly (1, 1, 1). Components are negative outside the gamut. Throws
/// Error{input} if a shipped table is missing.
[[nodiscard]] LinearRgb linear_rgb(const Curve& reflectance);

/// Decodes an sRGB code value x in [0, 1] to a linear value: x/12.92 up to 0.04045, otherwise ((x +
/// 0.055)/1.055)^2.4 [IEC61966, sec. 5.2].
[[nodiscard]] double srgb_decoded(double code);

/// Encoding of the values of an image.
struct Encoding {
  /// Exponent that linearises a value; 1 if values are linear, nothing if they are encoded as sRGB.
  std::optional<double> gamma;

  /// Linear value of an encoded one, which must not be negative unless the encoding is linear.
  [[nodiscard]] double decoded(double value) const;
};
inline constexpr Encoding kLinearEncoding{1.0};

/// Encoding that an image records in `kColorSpace`; sRGB if it records none, nothing for an unknown one.
[[nodiscard]] std::optional<Encoding> recorded_encoding(const Image& image);

/// Three smooth reflectances in [0, 1] that add up to 1 at every wavelength [Mallett2019]. Their colours
/// under `linear_rgb` are (1, 0, 0), (0, 1, 0) and (0, 0, 1), so a mixture has the colour of its weights. It
/// is a reflectance if the weights lie in [0, 1]. The logarithms of the spectra differ by quadratics in
/// wavelength, whose six coefficients satisfy the six conditions. Outside 380-780 nm, where colour hardly
/// determines them, they are constant.
struct RgbBasis {
  Curve red;
  Curve green;
  Curve blue;
};
/// The basis, computed at the first call. Thread-safe. Throws Error{input} if a shipped table is missing.
[[nodiscard]] const RgbBasis& rgb_basis();

/// Mixture of the basis with the weights `rgb`, each >= 0. Its values lie between the smallest and largest
/// weight; three equal weights give a constant. Throws like `rgb_basis`.
[[nodiscard]] Curve rgb_spectrum(const LinearRgb& rgb);

}  // namespace abbe

#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "io/diagnostics.h"
#include "spectral/curve.h"

namespace abbe {

/// Maximum luminous efficacy [lm/W]: 683 lm/W at 540 THz, as the factor of V(lambda) in air [CIE15].
inline constexpr double kLuminousEfficacy = 683.002;

/// Standard observers of the CIE: that of 1931 for fields of 2 degrees, that of 1964 for 10 degrees.
enum class Observer { cie1931, cie1964 };

/// Colour-matching functions of a standard observer, from `data/observer`.
struct ColorMatching {
  Curve x;
  Curve y;
  Curve z;
};
/// Colour-matching functions of an observer, loaded at the first call. Thread-safe. Throws Error{input} if
/// the shipped table is missing.
[[nodiscard]] const ColorMatching& color_matching(Observer observer);

/// Tristimulus values X, Y and Z. Each function states their scale.
using XYZ = std::array<double, 3>;
/// CIE 1976 L*, a* and b*; L* is 100 for the white.
using Lab = std::array<double, 3>;

/// Wavelengths of a colorimetric sum [nm], both ends included. The default is the range of the CIE tables of
/// the standard observers [CIE15, sec. 7.1].
struct SumRange {
  int low_nm = 360;
  int high_nm = 830;
};
/// Range of visible light, to which luminous efficacies refer.
inline constexpr SumRange kVisibleRange{380, 780};

/// Integral of the product of two or three curves [value nm] by a sum over every whole nanometre. It is the
/// exact integral if `a` or `b` has a knot between whole nanometres, or a jump above a thousandth of the
/// largest value of the product. If `c` has such knots or jumps, the sum takes its mean around each
/// nanometre. Exact integrals extend half a nanometre past both ends of `range`. Never throws.
[[nodiscard]] double sum_product(const Curve& a, const Curve& b, SumRange range = {});
[[nodiscard]] double sum_product(const Curve& a, const Curve& b, const Curve& c, SumRange range = {});

/// Contribution of each nanometre of the range to the tristimulus values of the perfect diffuser under an
/// illuminant [CIE15, sec. 7.1]. Element i belongs to `range.low_nm` + i. The Y of all elements add up to
/// 100; all values are NaN for an illuminant without Y. If the illuminant has structure between whole
/// nanometres, its power is distributed to the neighbouring ones. Throws like `color_matching`.
[[nodiscard]] std::vector<XYZ> tristimulus_weights(const Curve& illuminant, Observer observer,
                                                   SumRange range = {});

/// Tristimulus values of a reflectance under an illuminant, with Y = 100 for the perfect diffuser: the sum of
/// `tristimulus_weights` times the reflectance. A reflectance with structure between whole nanometres counts
/// with its mean around each. An illuminant with such structure gives the exact integral. NaN for an
/// illuminant without Y. Throws like `color_matching`.
[[nodiscard]] XYZ tristimulus(const Curve& illuminant, const Curve& reflectance, Observer observer,
                              SumRange range = {});

/// Chromaticity coordinates x, y.
using Chromaticity = std::array<double, 2>;

/// Chromaticity coordinates of tristimulus values; {0, 0} for black.
[[nodiscard]] Chromaticity chromaticity(const XYZ& xyz);
/// Chromaticity of a light for an observer; NaN if the observer's response to the light is zero. Throws like
/// `color_matching`.
[[nodiscard]] Chromaticity chromaticity(const Curve& light, Observer observer = Observer::cie1931);

/// CIE 1976 L*a*b* relative to `white`, both in the same scale [CIE15, sec. 8.2.1]. The values of `white`
/// must be positive. T is `double` or a type for automatic differentiation.
template <typename T>
[[nodiscard]] std::array<T, 3> xyz_to_lab(const std::array<T, 3>& xyz, const XYZ& white);

/// Inverse of `xyz_to_lab`, in the scale of `white`.
[[nodiscard]] XYZ lab_to_xyz(const Lab& lab, const XYZ& white);

/// Photometric integral of a spectral radiometric curve [X/nm], exact and not a sum. Gives lm, lx, cd or
/// cd/m^2 for X of W, W/m^2, W/sr or W/(m^2 sr), for the CIE 1931 observer. Throws like `color_matching`.
[[nodiscard]] double photometric(const Curve& spectral);

template <typename T>
std::array<T, 3> xyz_to_lab(const std::array<T, 3>& xyz, const XYZ& white) {
  using std::cbrt;
  using std::pow;
  const auto f = [](const T& t) {
    constexpr double kDelta = 6.0 / 29.0;
    if (t > T(kDelta * kDelta * kDelta)) return T(cbrt(t));
    return T(t / (3 * kDelta * kDelta) + 4.0 / 29.0);
  };
  const T fx = f(xyz[0] / white[0]);
  const T fy = f(xyz[1] / white[1]);
  const T fz = f(xyz[2] / white[2]);
  return {116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)};
}

/// Observer for the colours of a film.
struct FilmObserver {
  Observer observer = Observer::cie1931;
  /// Edges of the bands of a spectral image, strictly ascending [nm], one more than bands. If empty, the
  /// observer receives the light itself.
  std::vector<double> band_edges_nm = {};
};

/// Light as the bands of an image represent it: its mean over each band, and 0 outside them. `edges_nm` has
/// at least two elements. Throws Error{internal} unless they ascend strictly.
[[nodiscard]] Curve in_bands(const Curve& light, std::span<const double> edges_nm);

/// Chromaticity of a light in the bands of the image. It is that of the light itself if the bands contain
/// none of it within `kVisibleRange`. NaN if the observer's response to the light is zero. Throws like
/// `in_bands` and `color_matching`.
[[nodiscard]] Chromaticity chromaticity(const Curve& light, const FilmObserver& film_observer);

}  // namespace abbe

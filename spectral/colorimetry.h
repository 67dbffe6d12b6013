#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "io/diagnostics.h"
#include "spectral/curve.h"

namespace abbe {

/// Maximum luminous efficacy, 683 lm/W at 540 THz, as the factor of V(lambda) in air [CIE15] (lm/W).
inline constexpr double kLuminousEfficacy = 683.002;

enum class Observer { cie1931, cie1964 };

/// Colour-matching functions of a standard observer, from `data/observer`.
struct ColorMatching {
  Curve x;
  Curve y;
  Curve z;
};
/// Loaded once. Throws Error{input} when the shipped table is missing.
[[nodiscard]] const ColorMatching& color_matching(Observer observer);

using XYZ = std::array<double, 3>;
using Lab = std::array<double, 3>;

/// Wavelengths of a colorimetric sum [nm], both ends included; by default those for which the CIE tabulates
/// the standard observers [CIE15, sec. 7.1].
struct SumRange {
  int low_nm = 360;
  int high_nm = 830;
};
/// The range of visible light, to which luminous efficacies refer. Other programs truncate their sums to it;
/// it is an option for comparison with them.
inline constexpr SumRange kVisibleRange{380, 780};

/// 1 nm sums of the products of two and three curves, or the exact integral where `a` or `b` bends between
/// whole nanometres, or jumps there by more than a thousandth of what the other shows at most. A `c` that
/// does counts in the sum by its mean around each.
[[nodiscard]] double sum_product(const Curve& a, const Curve& b, SumRange range = {});
[[nodiscard]] double sum_product(const Curve& a, const Curve& b, const Curve& c, SumRange range = {});

/// What each nanometre of the range, from its low end on, adds to the tristimulus values of the perfect
/// diffuser under an illuminant, Y = 100 in all [CIE15, sec. 7.1]. The power of an illuminant that bends
/// between whole nanometres is shared among those next to it.
[[nodiscard]] std::vector<XYZ> tristimulus_weights(const Curve& illuminant, Observer observer,
                                                   SumRange range = {});

/// Tristimulus values of a reflectance under an illuminant, Y = 100 for the perfect diffuser: the sum of
/// `tristimulus_weights` times the reflectance, its mean around each nanometre if it bends between them; the
/// exact integral if the illuminant does.
[[nodiscard]] XYZ tristimulus(const Curve& illuminant, const Curve& reflectance, Observer observer,
                              SumRange range = {});

/// Chromaticity coordinates x, y.
using Chromaticity = std::array<double, 2>;

/// Chromaticity coordinates x, y; {0, 0} for black.
[[nodiscard]] Chromaticity chromaticity(const XYZ& xyz);
/// Chromaticity of a light as an observer sees it; not finite for a light that nobody sees.
[[nodiscard]] Chromaticity chromaticity(const Curve& light, Observer observer = Observer::cie1931);

/// CIE 1976 L*a*b* relative to `white`, both in the same scale [CIE15, sec. 8.2.1].
template <typename T>
[[nodiscard]] std::array<T, 3> xyz_to_lab(const std::array<T, 3>& xyz, const XYZ& white);

/// The inverse of `xyz_to_lab`.
[[nodiscard]] XYZ lab_to_xyz(const Lab& lab, const XYZ& white);

/// Photometric integral of a spectral radiometric curve [X/nm] (exact, not a sum): lm, lx, cd, or cd/m^2 for
/// W, W/m^2, W/sr, W/(m^2 sr).
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

}  // namespace abbe

#pragma once

#include <array>

#include "spectral/colorimetry.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Colour appearance models: they share all but the cones in which white is adapted, and whether what is
/// compressed are those or the cones of Hunt, Pointer and Estevez.
enum class AppearanceModel {
  ciecam02,  ///< [CIE159]
  cam16,     ///< [Li2017]
};

/// How colours are looked at, in an average surround (F = 1, c = 0.69, N_c = 1). By default as surface
/// colours in a light booth of 1000 lx [CIE159, table 2].
struct ViewingConditions {
  XYZ white;                       ///< Y = 100.
  double adapting_luminance = 60;  ///< L_A [cd/m^2].
  double background = 20;          ///< Y_b, of a white of 100.
  bool complete = false;           ///< Adaptation to the white: complete, or by L_A.
};

/// Correlates of appearance.
struct ColorAppearance {
  double lightness;     ///< J
  double chroma;        ///< C
  double colorfulness;  ///< M
  double hue_deg;       ///< h in [0, 360).
};

/// A model with all that depends on the viewing conditions alone worked out.
class Appearance {
 public:
  Appearance(AppearanceModel model, const ViewingConditions& conditions);

  /// Correlates of a colour whose white has Y = 100 [CIE159, sec. 3; Li2017, sec. 3]; all zero for black.
  [[nodiscard]] ColorAppearance operator()(const XYZ& xyz) const;

  /// J', a', b' of the uniform colour space of the model, in which the distance of two colours is their
  /// difference: J' = 1.7 J/(1 + 0.007 J), M' = ln(1 + 0.0228 M)/0.0228 [Luo2006, eq. 3; Li2017, sec. 5].
  [[nodiscard]] std::array<double, 3> uniform(const XYZ& xyz) const;

 private:
  [[nodiscard]] std::array<double, 3> compressed(const XYZ& xyz) const;

  Matrix3 to_adapted_;     // XYZ to cones under the adapted white, as they are compressed
  double adaptation_;      // F_L
  double background_;      // n
  double induction_;       // N_bb = N_cb
  double exponent_;        // z
  double white_response_;  // A_w
};

/// The distance of two colours in such a space.
[[nodiscard]] double distance_between(const std::array<double, 3>& a, const std::array<double, 3>& b);

}  // namespace abbe

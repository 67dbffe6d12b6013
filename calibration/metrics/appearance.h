#pragma once

#include <array>

#include "spectral/colorimetry.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Colour appearance models. They differ in the cone space of chromatic adaptation. The compression acts on
/// these cones (CAM16) or on those of Hunt, Pointer and Estevez (CIECAM02).
enum class AppearanceModel {
  ciecam02,  ///< [CIE159]
  cam16,     ///< [Li2017]
};

/// Viewing conditions in an average surround (F = 1, c = 0.69, N_c = 1). The defaults are those of surface
/// colours in a light booth of 1000 lx [CIE159, table 2].
struct ViewingConditions {
  XYZ white;                       ///< Adopted white, with Y = 100.
  double adapting_luminance = 60;  ///< L_A [cd/m^2].
  double background = 20;          ///< Y_b > 0, relative to a white of 100.
  /// True for complete adaptation to the white; false for a degree that follows from L_A.
  bool complete = false;
};

/// Correlates of appearance, on the scales of the models.
struct ColorAppearance {
  double lightness;     ///< Lightness J.
  double chroma;        ///< Chroma C.
  double colorfulness;  ///< Colourfulness M.
  double hue_deg;       ///< Hue angle h in [0, 360) degrees.
};

/// An appearance model, with everything precomputed that depends on the viewing conditions alone.
class Appearance {
 public:
  Appearance(AppearanceModel model, const ViewingConditions& conditions);

  /// Correlates of a colour on the scale of the white, Y = 100 [CIE159, sec. 3; Li2017, sec. 3]. J, C and M
  /// are 0 for black, whose hue has no meaning. A negative achromatic response counts as black.
  [[nodiscard]] ColorAppearance operator()(const XYZ& xyz) const;

  /// J', a' = M' cos h and b' = M' sin h of the uniform colour space of the model, in which distances are
  /// colour differences. J' = 1.7 J/(1 + 0.007 J), M' = ln(1 + 0.0228 M)/0.0228 [Luo2006, eq. 3; Li2017, sec.
  /// 5].
  [[nodiscard]] std::array<double, 3> uniform(const XYZ& xyz) const;

 private:
  [[nodiscard]] std::array<double, 3> compressed(const XYZ& xyz) const;

  Matrix3 to_adapted_;     // from XYZ to the adapted cones that are compressed
  double adaptation_;      // F_L
  double background_;      // n
  double induction_;       // N_bb = N_cb
  double exponent_;        // z
  double white_response_;  // A_w
};

/// Euclidean distance of two colours in any three-dimensional space.
[[nodiscard]] double distance_between(const std::array<double, 3>& a, const std::array<double, 3>& b);

/// Luminance of the diffuse white of pictures that do not record it: graphics white of [BT2408, sec. 2.2]
/// [cd/m^2].
inline constexpr double kReferenceWhite = 203;

/// I, T, P of a colour with absolute tristimulus values [cd/m^2], relative to a white D65: IC_TC_P with the
/// perceptual quantiser [BT2100, table 7], and T = C_T/2 [BT2124, annex 1].
[[nodiscard]] std::array<double, 3> itp(const XYZ& absolute);

/// Delta E_ITP of two results of `itp`, 720 sqrt(dI^2 + dT^2 + dP^2) [BT2124, annex 1]. A value of 1 is just
/// noticeable under the best conditions.
[[nodiscard]] double delta_e_itp(const std::array<double, 3>& a, const std::array<double, 3>& b);

}  // namespace abbe

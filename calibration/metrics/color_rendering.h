#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "spectral/colorimetry.h"
#include "spectral/curve.h"

namespace abbe {

/// Colour rendering by CIE 13.3. Indices are at most 100, for a light that renders as its reference does, and
/// may be negative.
struct ColorRendering {
  double general = 0;                ///< Ra, the mean of R1 to R8.
  std::array<double, 14> special{};  ///< R1 to R14.
};

/// Colour rendering indices of the test-colour samples TCS01-TCS14: R_i = 100 - 4.6 d_i [CIE13, sec. 5]. d_i
/// is the distance in U*V*W* between a sample under the light and under the reference of the same colour
/// temperature. The reference is a black body below 5000 K, else daylight. Uses von Kries' adaptation in u, v
/// and 1 nm sums over `range`. Empty for lights without a colour temperature up to 25 000 K.
[[nodiscard]] std::optional<ColorRendering> color_rendering(const Curve& light, SumRange range = {});

/// Means over the samples in one range of hue: positions in the plane a', b' and changes of colour. All are
/// NaN if the range has no samples under the reference.
struct HueBin {
  std::array<double, 2> test{};       ///< Mean a', b' under the light.
  std::array<double, 2> reference{};  ///< Mean a', b' under the reference.
  double fidelity = 0;                ///< R_f,h, on the scale of R_f.
  /// R_cs,h, as a fraction of the reference's chroma; positive for more saturated colours.
  double chroma_shift = 0;
  double hue_shift = 0;  ///< R_hs,h [rad]; positive towards larger hue angles.

  [[nodiscard]] bool has_samples() const { return !std::isnan(fidelity); }
};

/// Colour fidelity and gamut by CIE 224 and ANSI/IES TM-30. R_f is above 0 and at most about 100; R_g of 100
/// means an equal area.
struct ColorFidelity {
  static constexpr std::size_t kBins = 16;
  double fidelity = 0;               ///< R_f
  double gamut = 0;                  ///< R_g; NaN if a bin has no samples.
  std::vector<double> samples;       ///< R_f of each of the 99 samples, in their order.
  std::array<HueBin, kBins> bins{};  ///< Bins of 22.5 degrees, from hue angle 0 on.
};

/// Colour fidelity and gamut of a light for the 99 colour evaluation samples. The reference has the same
/// colour temperature: a black body (below 4000 K), daylight (above 5000 K) or a mixture. Colours are
/// CAM02-UCS for the CIE 1964 observer with L_A = 100, Y_b = 20 and complete adaptation, from 1 nm sums over
/// `range`.
///
/// R_f = 10 ln(1 + exp((100 - 6.73 dE)/10)) of the mean difference [CIE224, sec. 4]. R_g is 100 times the
/// ratio of the areas of the polygons of the bins' means, light over reference [TM30, sec. 4]. The hue under
/// the reference selects the bin. If one of the 16 bins has no samples, R_g is NaN. Empty for lights without
/// a colour temperature up to 25 000 K.
[[nodiscard]] std::optional<ColorFidelity> color_fidelity(const Curve& light, SumRange range = {});

/// Colour differences of two reflectances that look alike, or nearly so, in one light.
struct Metamerism {
  double reference_76;  ///< Difference in L*a*b* under the reference light.
  double index_76;      ///< Difference in L*a*b* under the test light: the special metamerism index M_t.
  double index_2000;    ///< CIEDE2000 under the test light.
};

/// Special metamerism index for a change of illuminant, for the CIE 1931 observer [CIE15, sec. 9.2]. Factors
/// on X, Y and Z of the second reflectance, which make both match under the reference light, are applied
/// under the test light too. Lights may have any scale. Uses 1 nm sums over `range`. Throws Error{input} if
/// X, Y or Z of the second reflectance is not positive under the reference light.
[[nodiscard]] Metamerism metamerism(const Curve& first, const Curve& second, const Curve& reference,
                                    const Curve& test, SumRange range = {});

}  // namespace abbe

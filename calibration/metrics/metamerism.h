#pragma once

#include "spectral/colorimetry.h"
#include "spectral/curve.h"

namespace abbe {

/// Colour differences of two reflectances that look alike, or nearly so, in one light.
struct Metamerism {
  double reference_76;  ///< Difference in L*a*b* under the reference light.
  double index_76;      ///< Difference in L*a*b* under the test light: the special metamerism index M_t.
  double index_2000;    ///< CIEDE2000 under the test light.
};

/// Special metamerism index for a change of illuminant, for the CIE 1931 observer [CIE15, sec. 9.2]. Factors
/// on X, Y and Z of the second reflectance first make both match under the reference light. They are applied
/// under the test light too. Lights may have any scale. Uses 1 nm sums over `range`. Throws Error{input} if
/// X, Y or Z of the second reflectance is not positive under the reference light.
[[nodiscard]] Metamerism metamerism(const Curve& first, const Curve& second, const Curve& reference,
                                    const Curve& test, SumRange range = {});

}  // namespace abbe

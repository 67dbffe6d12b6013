#pragma once

#include "spectral/colorimetry.h"
#include "spectral/curve.h"

namespace abbe {

/// How two reflectances differ that look alike in one light, or nearly.
struct Metamerism {
  double reference_76;  ///< Difference in L*a*b* under the reference light.
  double index_76;      ///< Under the test light: the special metamerism index M_t.
  double index_2000;    ///< The same by CIEDE2000.
};

/// Special metamerism index for a change of illuminant, for the CIE 1931 observer [CIE15, sec. 9.2]: X, Y and
/// Z of the second under the test light are multiplied first by what makes the two match under the reference
/// light; 1 nm sums over a range. Throws Error{input} for a reflectance that is black there.
[[nodiscard]] Metamerism metamerism(const Curve& first, const Curve& second, const Curve& reference,
                                    const Curve& test, SumRange range = {});

}  // namespace abbe

#pragma once

#include <cmath>
#include <vector>

#include "spectral/curve.h"

namespace abbe {

/// Scale of an interference filter's spectrum for light at an angle theta to its normal in air:
/// lambda(theta)/lambda_0 = sqrt(1 - sin^2 theta / n_eff^2) [Smith2008, ch. 11]. `effective_index` >= 1 lies
/// between the indices of its layers. The result is 1 along the normal and smaller at an angle.
template <typename S>
[[nodiscard]] S blue_shift(S cos_theta, S effective_index) {
  const S sine2 = (1 - cos_theta) * (1 + cos_theta);
  return std::sqrt(1 - sine2 / (effective_index * effective_index));
}

/// An interference filter. At an angle, its transmittance is that along the normal, shifted to shorter
/// wavelengths.
struct InterferenceFilter {
  Curve transmittance;     ///< Along the normal, in [0, 1].
  double effective_index;  ///< That of `blue_shift`, at least 1.
};

/// A stack of filters: the transmittance of those that do not depend on the angle, and the others.
struct FilterStack {
  /// Product of all factors that do not depend on the angle.
  Curve fixed = Curve(1.0);
  std::vector<InterferenceFilter> shifting = {};
};

/// Upper bound of the transmittance over all angles whose cosine is at least `min_cosine`, piecewise constant
/// in steps of at most a nanometre. It is zero exactly where all these transmittances are zero.
[[nodiscard]] Curve envelope(const InterferenceFilter& filter, double min_cosine);

}  // namespace abbe

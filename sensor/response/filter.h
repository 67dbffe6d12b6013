#pragma once

#include <cmath>
#include <vector>

#include "spectral/curve.h"

namespace abbe {

/// lambda(theta)/lambda_0 = sqrt(1 - sin^2 theta / n_eff^2): what an interference filter's spectrum is
/// stretched by for light at an angle theta to its normal, in air. `effective_index` >= 1 lies between those
/// of its layers [Smith2008, ch. 11].
template <typename S>
[[nodiscard]] S blue_shift(S cos_theta, S effective_index) {
  const S sine2 = (1 - cos_theta) * (1 + cos_theta);
  return std::sqrt(1 - sine2 / (effective_index * effective_index));
}

/// A filter of thin layers, whose transmittance at an angle is that along the normal, moved to shorter
/// wavelengths.
struct InterferenceFilter {
  Curve transmittance;  ///< Along the normal.
  double effective_index;
};

/// Filters one behind the other: the transmittance of those that do not depend on the angle, and the others.
struct FilterStack {
  Curve fixed = Curve(1.0);
  std::vector<InterferenceFilter> shifting = {};
};

/// The largest transmittance at any angle whose cosine is at least `least_cosine`, as steps of at most a
/// nanometre: nowhere less, and zero exactly where no angle lets anything through.
[[nodiscard]] Curve envelope(const InterferenceFilter& filter, double least_cosine);

}  // namespace abbe

#pragma once

#include <vector>

#include "scene/scene.h"
#include "spectral/curve.h"

namespace abbe {

/// What the lights of a scene emit, as its sensor sees it.
struct Emissions {
  /// Mean emissions, proportional ones once, so that many lamps of one kind cost what one costs and starve no
  /// other kind of wavelengths.
  std::vector<Curve> distinct;
  std::vector<double> seen;  ///< Of each light: the integral of |emission x response| of its largest channel.
};
[[nodiscard]] Emissions emissions_of(const Scene& scene);

}  // namespace abbe

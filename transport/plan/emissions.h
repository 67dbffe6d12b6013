#pragma once

#include <vector>

#include "scene/scene.h"
#include "spectral/curve.h"

namespace abbe {

/// Emission of a scene's lights as weighted by its sensor.
struct Emissions {
  /// Mean emission curves, with proportional ones merged. Many lights of one kind then cost as much as one,
  /// and do not take wavelengths from other kinds.
  std::vector<Curve> distinct;
  std::vector<double>
      /// Sensor-weighted emission per light: integral of |emission x response| for the channel with the
      /// largest one.
      sensor_emissions;
};
[[nodiscard]] Emissions emissions_of(const Scene& scene);

}  // namespace abbe

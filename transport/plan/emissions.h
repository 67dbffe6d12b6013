#pragma once

#include <vector>

#include "scene/scene.h"
#include "spectral/curve.h"

namespace abbe {

/// Emission of a scene's lights as weighted by its sensor.
struct Emissions {
  /// Mean emission curves, one of each set of curves that differ in a factor only, up to a factor. Many
  /// lights of one kind then cost as much as one, and do not take wavelengths from other kinds.
  std::vector<Curve> distinct;
  /// Sensor-weighted emission, one per light in the order of `Scene::lights`: the integral of |emission x
  /// response| over wavelength for the channel with the largest one. 0 if the sensor records nothing of the
  /// light.
  std::vector<double> sensor_emissions;
};
/// Emissions of all lights of a scene.
[[nodiscard]] Emissions emissions_of(const Scene& scene);

}  // namespace abbe

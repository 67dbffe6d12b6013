#pragma once

#include <optional>

#include "materials/medium/grid.h"
#include "materials/medium/phase.h"
#include "spectral/curve.h"

namespace abbe {

/// A medium that absorbs and scatters light along its path. `absorption_per_m` and `scattering_per_m` are its
/// coefficients of absorption and scattering [1/m] over the wavelength in air [nm].
struct Medium {
  Curve absorption_per_m = Curve(0.0);  ///< 0 or more.
  Curve scattering_per_m = Curve(0.0);  ///< 0 or more.
  PhaseFunction phase = IsotropicPhase{};
  /// Factor of both coefficients in an inhomogeneous medium; empty if homogeneous.
  std::optional<PlacedGrid> grid = {};

  [[nodiscard]] bool absorbs() const { return absorption_per_m.max() > 0; }
  [[nodiscard]] bool scatters() const { return scattering_per_m.max() > 0; }
};

}  // namespace abbe

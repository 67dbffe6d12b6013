#pragma once

#include <optional>

#include "materials/medium/grid.h"
#include "materials/medium/phase.h"
#include "spectral/curve.h"

namespace abbe {

/// A medium that absorbs and scatters light along its path. Per metre it absorbs the fraction
/// `absorption_per_m` and scatters the fraction `scattering_per_m` by the phase function.
struct Medium {
  Curve absorption_per_m = Curve(0.0);  ///< 0 or more.
  Curve scattering_per_m = Curve(0.0);  ///< 0 or more.
  PhaseFunction phase = IsotropicPhase{};
  std::optional<PlacedGrid> grid = {};  ///< Factor of both in an inhomogeneous medium.

  [[nodiscard]] bool absorbs() const { return absorption_per_m.max() > 0; }
  [[nodiscard]] bool scatters() const { return scattering_per_m.max() > 0; }
};

}  // namespace abbe

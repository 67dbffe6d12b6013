#pragma once

#include <optional>

#include "materials/medium/grid.h"
#include "materials/medium/phase.h"
#include "spectral/curve.h"

namespace abbe {

/// What light meets on its way through matter that scatters: per metre it loses the share `absorption_per_m`
/// for good and turns the share `scattering_per_m` by the phase function.
struct Medium {
  Curve absorption_per_m = Curve(0.0);  ///< 0 or more.
  Curve scattering_per_m = Curve(0.0);  ///< 0 or more.
  PhaseFunction phase = IsotropicPhase{};
  std::optional<PlacedGrid> grid = {};  ///< Multiplies both, where matter is not the same everywhere.

  [[nodiscard]] bool absorbs() const { return absorption_per_m.max() > 0; }
  [[nodiscard]] bool scatters() const { return scattering_per_m.max() > 0; }
};

}  // namespace abbe

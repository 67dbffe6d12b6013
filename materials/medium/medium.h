#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <ImathVec.h>

#include "materials/medium/phase.h"
#include "spectral/curve.h"

namespace abbe {

/// Densities at the nodes of a grid, interpolated trilinearly and 0 outside. They multiply the absorption and
/// scattering of a homogeneous medium.
struct DensityGrid {
  std::array<int, 3> size;     ///< Nodes along x, y and z, at least 2 each.
  std::vector<float> density;  ///< Densities, 0 or more, with x running fastest.
};

/// A segment of a ray through a grid, in the units of `PlacedGrid::march` [m].
struct GridSegment {
  float distance;  ///< Distance from the origin at which the segment ends.
  float column;    ///< Integral of the density along the segment.
  bool reached;    ///< True if the requested column was reached before the end of the ray.
};

/// A grid in space. `from` is the first node and `to` the last [m]; each coordinate of `to` is larger.
struct PlacedGrid {
  std::shared_ptr<const DensityGrid> grid;
  Imath::V3d from;
  Imath::V3d to;

  /// Follows the ray until the integral of density is `column` or the distance is `distance`. Both may be
  /// infinite, and both are in units of the length of `direction`, which represents 1 m. Outside the grid the
  /// density is 0, so a ray that misses it has column 0 at `distance`. The result is exact: along a line
  /// through a cell, the density is a cubic, which Simpson's rule integrates exactly.
  [[nodiscard]] GridSegment march(const Imath::V3d& origin, const Imath::V3d& direction, float distance,
                                  float column) const;
};

/// A medium that absorbs and scatters light along its path, with coefficients over the wavelength in air
/// [nm].
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

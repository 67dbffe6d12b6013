#pragma once

#include <array>
#include <memory>
#include <vector>

#include <ImathVec.h>

namespace abbe {

/// Densities at the nodes of a grid, linear between them along each axis (trilinear) and 0 outside. They
/// multiply what homogeneous matter absorbs and scatters.
struct DensityGrid {
  std::array<int, 3> size;     ///< Nodes along x, y and z, at least 2 each.
  std::vector<float> density;  ///< 0 or more, x running fastest.
};

/// A part of a way through a grid, and the density integrated along it [m].
struct GridStretch {
  float distance;
  float column;
  bool reached;  ///< The column asked for, before the end of the way.
};

/// A grid from its first node at `from` to its last one at `to` [m], each coordinate of which is greater.
struct PlacedGrid {
  std::shared_ptr<const DensityGrid> grid;
  Imath::V3d from;
  Imath::V3d to;

  /// Goes along the ray until the integral of density is `column` or the distance `distance`; both may be
  /// infinite, and both count in lengths of `direction`, which stands for 1 m. Exact: within a cell the
  /// density along a line is a cubic, whose integral Simpson's rule gives.
  [[nodiscard]] GridStretch march(const Imath::V3d& origin, const Imath::V3d& direction, float distance,
                                  float column) const;
};

}  // namespace abbe

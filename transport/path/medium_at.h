#pragma once

#include "scene/scene.h"
#include "spectral/packet.h"
#include "transport/path/medium_stack.h"

namespace abbe {

/// `PlacedGrid::march` along a ray of the world, in a shape that holds the grid.
[[nodiscard]] GridStretch march_grid(const PlacedGrid& grid, const Shape& shape, const BasicRay<double>& ray,
                                     float distance, float column);

/// The matter a path segment runs through, at the path's wavelengths.
struct MediumAt {
  bool attenuating = false;
  SampledSpectrum extinction_per_m;       ///< What is absorbed and scattered together.
  const Medium* scattering = nullptr;     ///< What scatters, if anything does.
  SampledSpectrum scattering_per_m = {};  ///< Where something does.
  const PlacedGrid* grid = nullptr;       ///< Multiplies both, only in media without an interface.
  const Shape* grid_shape = nullptr;      ///< The shape that holds the grid, which moves with it.

  /// Attenuates the lanes over a distance [m], perhaps an infinite one. In a grid the distance is the
  /// integral of density along the way.
  void attenuate(SampledSpectrum& throughput, float distance) const {
    if (attenuating) throughput *= transmittance(extinction_per_m, distance);
  }
  /// How far along a ray a column of matter lasts, within `distance`.
  [[nodiscard]] GridStretch march(const Ray& ray, float distance, float column) const {
    if (grid != nullptr) {
      BasicRay<double> exact{Imath::V3d(ray.origin), Imath::V3d(ray.direction)};
      exact.time = ray.time;
      return march_grid(*grid, *grid_shape, exact, distance, column);
    }
    const bool reached = column < distance;
    return {reached ? column : distance, reached ? column : distance, reached};
  }
};

/// The matter of the innermost of the shapes in `inside`, or air.
[[nodiscard]] MediumAt medium_at(const Scene& scene, const MediumStack& inside,
                                 const SampledSpectrum& wavelengths_nm);

/// What surrounds a point of a path: the shapes it lies in, and their matter at the path's wavelengths.
struct Surroundings {
  MediumStack inside;
  MediumAt medium;

  /// Passes into `beyond`.
  void enter(const Scene& scene, const MediumStack& beyond, const SampledSpectrum& wavelengths_nm) {
    inside = beyond;
    medium = medium_at(scene, inside, wavelengths_nm);
  }
};

}  // namespace abbe

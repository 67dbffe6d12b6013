#pragma once

#include "scene/scene.h"
#include "spectral/sampled_spectrum.h"
#include "transport/path/medium_stack.h"

namespace abbe {

/// `PlacedGrid::march` along a world-space ray through the shape that contains the grid, at the ray's time.
/// `distance` [m] and `column` [m] may be infinite.
[[nodiscard]] GridSegment march_grid_along(const PlacedGrid& grid, const Shape& shape,
                                           const BasicRay<double>& ray, float distance, float column);

/// Medium of a path segment, at the path's wavelengths.
struct MediumAt {
  bool attenuating = false;               ///< False if the medium neither absorbs nor scatters.
  SampledSpectrum extinction_per_m;       ///< Absorption plus scattering; 0 if not `attenuating`.
  const Medium* scattering = nullptr;     ///< Scattering medium; nullptr if none.
  SampledSpectrum scattering_per_m = {};  ///< Valid if `scattering` is set.
  const PlacedGrid* grid = nullptr;   ///< Multiplies both coefficients; only in media without an interface.
  const Shape* grid_shape = nullptr;  ///< Shape that contains the grid and moves with it.

  /// Multiplies `throughput` by the transmittance over a distance [m], which may be infinite. With a grid,
  /// `distance` is the integral of its density along the segment [m].
  void attenuate(SampledSpectrum& throughput, float distance) const {
    if (attenuating) throughput *= transmittance(extinction_per_m, distance);
  }
  /// Distance [m] along a ray at which the density integral equals `column` [m], limited to `distance` [m].
  /// Without a grid the density is 1.
  [[nodiscard]] GridSegment march(const Ray& ray, float distance, float column) const {
    if (grid != nullptr) {
      BasicRay<double> exact{Imath::V3d(ray.origin), Imath::V3d(ray.direction)};
      exact.time = ray.time;
      return march_grid_along(*grid, *grid_shape, exact, distance, column);
    }
    const bool reached = column < distance;
    return {reached ? column : distance, reached ? column : distance, reached};
  }
};

/// Medium of the innermost shape of the stack; for an empty stack air, which does not attenuate.
[[nodiscard]] MediumAt medium_at(const Scene& scene, const MediumStack& stack,
                                 const SampledSpectrum& wavelengths_nm);

/// Media around a point of a path: the shapes that contain it, and the current medium at the path's
/// wavelengths.
struct MediumState {
  MediumStack stack;
  MediumAt medium;

  /// Replaces the stack by `new_stack` and sets the medium at the path's wavelengths.
  void enter(const Scene& scene, const MediumStack& new_stack, const SampledSpectrum& wavelengths_nm) {
    stack = new_stack;
    medium = medium_at(scene, stack, wavelengths_nm);
  }
};

}  // namespace abbe

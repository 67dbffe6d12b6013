#pragma once

#include <array>

#include <ImathVec.h>

#include "materials/interface/mueller.h"

namespace abbe {

/// Stokes vector (I, Q, U, V) at one wavelength. `docs/physics/conventions.md` defines the signs.
using StokesVector = std::array<double, 4>;

/// Full Mueller matrix, for column vectors.
struct FullMueller {
  std::array<StokesVector, 4> rows;

  [[nodiscard]] static FullMueller identity();
  /// Matrix of an event that passes on the fraction `power` of unpolarised light, in the frame of the event's
  /// axis: `power` times the normalised `elements`.
  [[nodiscard]] static FullMueller of(const MuellerElements<double>& elements, double power);

  /// Stokes vector of `light` after the event.
  [[nodiscard]] StokesVector operator*(const StokesVector& light) const;
  /// Matrix of the event `before` followed by this one.
  [[nodiscard]] FullMueller operator*(const FullMueller& before) const;
  FullMueller& operator*=(double power);
};

/// Effect of a ray's events so far on the polarisation of its light.
struct RayPolarisation {
  FullMueller mueller = FullMueller::identity();  ///< From the first frame to the last one.
  Imath::V3d first_axis, last_axis;  ///< First axes of both frames: unit vectors perpendicular to the ray.

  /// State of a ray that starts along the unit vector `direction`. The first axis is horizontal,
  /// perpendicular to the ray and to z; for a ray along z it is x.
  explicit RayPolarisation(const Imath::V3d& direction)
      : first_axis(across(direction, {0, 0, 1})), last_axis(first_axis) {}

  /// Rotates the last frame to `axis`, which is perpendicular to the unit vector `direction` along which the
  /// light travels.
  void turn_to(const Imath::V3d& axis, const Imath::V3d& direction);
};

}  // namespace abbe

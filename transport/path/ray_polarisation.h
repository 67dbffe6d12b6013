#pragma once

#include <array>

#include <ImathVec.h>

#include "materials/interface/mueller.h"

namespace abbe {

/// A Stokes vector (I, Q, U, V) of one wavelength. `docs/physics/conventions.md` says what the signs mean.
using StokesVector = std::array<double, 4>;

/// Mueller's matrix in full, for columns of Stokes vectors.
struct FullMueller {
  std::array<StokesVector, 4> rows;

  [[nodiscard]] static FullMueller identity();
  /// That of an event which leads on `power` of unpolarised light, in a frame of the event's axis.
  [[nodiscard]] static FullMueller of(const MuellerElements<double>& elements, double power);

  [[nodiscard]] StokesVector operator*(const StokesVector& light) const;
  [[nodiscard]] FullMueller operator*(const FullMueller& before) const;
  FullMueller& operator*=(double power);
};

/// What a ray's way so far has done to the polarisation of its light.
struct PolarisedWay {
  FullMueller mueller = FullMueller::identity();  ///< From the frame of the first axis to that of the last.
  Imath::V3d first_axis, last_axis;  ///< First axes of both frames, unit vectors across the ray there.

  /// Of a ray that sets out along the unit vector `direction`: the first axis is horizontal, across it and z,
  /// and along x where it runs along z.
  explicit PolarisedWay(const Imath::V3d& direction)
      : first_axis(across(direction, {0, 0, 1})), last_axis(first_axis) {}

  /// Tells the light, which runs along the unit vector `direction`, in the frame of another axis.
  void turn_to(const Imath::V3d& axis, const Imath::V3d& direction);
};

}  // namespace abbe

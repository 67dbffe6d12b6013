#pragma once

#include <optional>

#include <ImathVec.h>

#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "materials/material.h"

namespace abbe {

/// A ray of one wavelength at a surface.
struct SmoothLookup {
  double wavelength_nm;
  double cos_i;        ///< Cosine of the angle of incidence, in [0, 1].
  bool inside;         ///< True if the ray arrives from inside the medium that the surface bounds.
  double outside = 1;  ///< Index of the medium outside, relative to air.
  std::optional<Imath::V2f> coordinates{};  ///< Surface coordinates; empty if unknown.
};

/// Reflectance and transmittance of the delta lobes, in double precision by the formulas of the model. T is 0
/// if the transmitted light is scattered or absorbed inside. A model without polarisation returns equal
/// values for s and p. Empty if the material has no delta lobe, or if a textured value is needed at unknown
/// coordinates.
[[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const Material& material,
                                                               const SmoothLookup& at);

/// Mueller matrices of the delta lobes. All elements are 0 if the lobe depolarises.
struct SmoothMueller {
  InterfaceMueller<double> matrices;
  /// Axis of a thin element in the plane of the surface, with x along u. The axis of the matrices is its
  /// projection perpendicular to the ray. Empty if that axis is perpendicular to the plane of incidence.
  std::optional<Imath::V2d> axis = {};
};
/// Mueller matrices of the delta lobes; empty if `smooth_power` is empty.
[[nodiscard]] std::optional<SmoothMueller> smooth_mueller(const Material& material, const SmoothLookup& at);

}  // namespace abbe

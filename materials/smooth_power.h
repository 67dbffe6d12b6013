#pragma once

#include <optional>

#include <ImathVec.h>

#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "materials/material.h"

namespace abbe {

/// A ray of one wavelength that arrives at a surface.
struct SmoothLookup {
  double wavelength_nm;  ///< Wavelength in air.
  double cos_i;          ///< Cosine of the angle of incidence, in [0, 1].
  bool inside;           ///< True if the ray arrives from inside the medium that the surface bounds.
  double outside = 1;    ///< Index of the medium outside, relative to air.
  std::optional<Imath::V2f> coordinates{};  ///< Surface coordinates; empty if unknown.
};

/// Reflectance and transmittance of the delta lobes, in double precision by the formulas of the model. T is
/// the power that crosses the surface; it is 0 if the surface is opaque. A model without polarisation returns
/// equal values for s and p. A mixture adds up its components with their weights and leaves out those without
/// a result. Empty if the material has no delta lobe, or if a textured value is needed at unknown
/// coordinates.
[[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const Material& material,
                                                               const SmoothLookup& at);

/// Normalised Mueller matrices of the delta lobes, without the power of `smooth_power`. All elements are 0 if
/// the lobe depolarises.
struct SmoothMueller {
  InterfaceMueller<double> matrices;
  /// Axis of a thin element in the plane of the surface, with x along u. The axis of the matrices is its
  /// projection perpendicular to the ray. Empty if the axis of the matrices is perpendicular to the plane of
  /// incidence.
  std::optional<Imath::V2d> axis = {};
};
/// Mueller matrices of the delta lobes; empty if `smooth_power` is empty.
[[nodiscard]] std::optional<SmoothMueller> smooth_mueller(const Material& material, const SmoothLookup& at);

}  // namespace abbe

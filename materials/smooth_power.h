#pragma once

#include <optional>

#include <ImathVec.h>

#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "materials/material.h"

namespace abbe {

/// How one ray of one wavelength meets a surface.
struct SmoothLookup {
  double wavelength_nm;
  double cos_i;                             ///< In [0, 1].
  bool inside;                              ///< From within the matter that the surface bounds.
  double outside = 1;                       ///< Index of what that matter is in, relative to air.
  std::optional<Imath::V2f> coordinates{};  ///< Of the surface; unknown where nothing.
};

/// What a surface sends on in single directions, the mirror's and through it, by the formulas of its model in
/// double precision; T is 0 where what is let in is scattered or absorbed there. Of unpolarised light alone
/// where the model knows no polarisation. Nothing of a surface that sends none on so, nor where textures
/// decide at unknown coordinates.
[[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const Material& material,
                                                               const SmoothLookup& at);

/// What that does to polarisation, all elements being 0 where it depolarises.
struct SmoothMueller {
  MuellerBothWays<double> ways;
  /// In the surface, x being along u; of thin elements, whose axis is its projection across the ray. Without
  /// it the axis is that across the plane of incidence.
  std::optional<Imath::V2d> axis = {};
};
/// Nothing where `smooth_power` says nothing.
[[nodiscard]] std::optional<SmoothMueller> smooth_mueller(const Material& material, const SmoothLookup& at);

}  // namespace abbe

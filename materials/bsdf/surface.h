#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <ImathVec.h>

#include "materials/index/refractive_index.h"
#include "materials/interface/coating.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "materials/medium/medium.h"
#include "materials/texture/spectral_texture.h"

namespace abbe {

// Parts of the materials, whose member functions `SurfaceModel` (`materials/material.h`) describes.

/// Kinds of lobes into which a material may scatter, by its model alone: a black diffuse material has a
/// spread lobe. The boundary of a medium without an interface has none.
struct Lobes {
  bool delta = false;  ///< True for single directions, as of mirrors and smooth glass, which may focus light.
  bool spread = false;  ///< True for directions of finite pdf, to which next-event estimation applies.
};

/// A ray of one wavelength that arrives at a surface.
struct SmoothLookup {
  double wavelength_nm;  ///< Wavelength in air.
  double cos_i;          ///< Cosine of the angle of incidence, in [0, 1].
  bool inside;           ///< True if the ray arrives from inside the medium that the surface bounds.
  double outside = 1;    ///< Index of the medium outside, relative to air.
  std::optional<Imath::V2f> coordinates{};  ///< Surface coordinates; empty if unknown.

  /// The power of a surface that transmits the fraction T undeflected and reflects nothing.
  [[nodiscard]] FresnelPower<double> undeflected(double T) const { return {0, 0, T, T, cos_i}; }
};

/// Normalised Mueller matrices of the delta lobes. All elements are 0 if the lobe depolarises.
struct SmoothMueller {
  InterfaceMueller<double> matrices;
  /// Axis of a thin element in the plane of the surface, with x along u. The axis of the matrices is its
  /// projection perpendicular to the ray. Empty if the axis of the matrices is perpendicular to the plane of
  /// incidence.
  std::optional<Imath::V2d> axis = {};
};

/// `power` without what enters an opaque surface.
[[nodiscard]] inline FresnelPower<double> without_transmission(const FresnelPower<double>& power) {
  return {power.Rs, power.Rp, 0, 0, 0};
}

/// A refractive index that a material uses, with its name. The material owns both and must outlive this.
struct IndexUse {
  const std::string* name;
  const RefractiveIndex* index;
};

/// The indices of a coating, one for each entry of `Coating::materials`.
[[nodiscard]] inline std::vector<IndexUse> indices_of(const Coating& coating) {
  std::vector<IndexUse> uses;
  for (const Coating::Material& film : coating.materials) uses.push_back({&film.index_name, &film.index});
  return uses;
}

/// The index inside a surface under the name `name`, followed by those of its coating.
[[nodiscard]] inline std::vector<IndexUse> indices_of(const std::string& name, const RefractiveIndex& index,
                                                      const Coating& coating) {
  std::vector<IndexUse> uses = indices_of(coating);
  uses.insert(uses.begin(), {&name, &index});
  return uses;
}

/// The part common to all opaque surfaces without an index.
struct OpaqueSurface {
  SpectralTexture reflectance;  ///< In [0, 1]; the model defines for which light.

  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
  [[nodiscard]] static constexpr bool opaque() { return true; }
  [[nodiscard]] std::size_t texture_bytes() const { return reflectance.memory_bytes(); }
};

}  // namespace abbe

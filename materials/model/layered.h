#pragma once

#include <string>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/medium/medium.h"
#include "materials/model/index_use.h"
#include "materials/texture/spectral_texture.h"

namespace abbe {

/// Internal diffuse reflectance (`diffuse_reflectance_inside`) of a transparent smooth coat of `index` in
/// air, every 1 nm from 300 to 1100 nm.
[[nodiscard]] Curve inner_reflectance(const RefractiveIndex& index);

/// A Lambertian ground under a smooth transparent coat, such as glazed or varnished paint. `SurfaceModel`
/// describes the member functions.
struct CoatedDiffuseMaterial {
  std::string index_name;
  RefractiveIndex index;        ///< Index of the coat: n in [1, 100), without k.
  SpectralTexture reflectance;  ///< Reflectance of the uncoated ground, in [0, 1].
  /// Internal diffuse reflectance in air; other media have their own.
  Curve inner = inner_reflectance(index);

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true, .spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return true; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior_index() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }
  [[nodiscard]] std::size_t texture_bytes() const { return reflectance.memory_bytes(); }
};

/// A pane of glass modelled as one surface that does not deflect light, by `ThinGlassBsdf`. `SurfaceModel`
/// describes the member functions.
struct ThinGlassMaterial {
  std::string index_name;
  RefractiveIndex index;  ///< k makes the pane absorb.
  double thickness = 0;   ///< Thickness of the pane [m].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool needs_coordinates() { return false; }
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] static constexpr bool opaque() { return false; }
  [[nodiscard]] static constexpr const RefractiveIndex* interior_index() { return nullptr; }
  [[nodiscard]] static constexpr const Medium* medium() { return nullptr; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }
  [[nodiscard]] static constexpr std::size_t texture_bytes() { return 0; }
};

}  // namespace abbe

#pragma once

#include <string>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/index/refractive_index.h"
#include "materials/texture/spectral_texture.h"

namespace abbe {

/// What a clear smooth coat of `index` throws back of diffuse light from within, over all wavelengths.
[[nodiscard]] Curve inner_reflectance(const RefractiveIndex& index);

/// A Lambertian ground under a smooth clear coat, such as glazed or varnished paint.
struct CoatedDiffuseMaterial {
  std::string index_name;
  RefractiveIndex index;        ///< Of the coat: n in [1, 100), no k.
  SpectralTexture reflectance;  ///< Of the bare ground, in [0, 1].
  Curve inner = inner_reflectance(index);

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true, .spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
};

/// A pane of glass modelled as one surface, which light crosses without being bent.
struct ThinGlassMaterial {
  std::string index_name;
  RefractiveIndex index;  ///< Its k absorbs.
  double thickness = 0;   ///< [m]

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
};

}  // namespace abbe

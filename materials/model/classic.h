#pragma once

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/texture/spectral_texture.h"

namespace abbe {

/// The ideal mirror.
struct MirrorMaterial {
  SpectralTexture reflectance;  ///< In [0, 1].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const { return MirrorBsdf{reflectance(at)}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
};

/// A mirror by Schlick's approximation.
struct SchlickMaterial {
  SpectralTexture r0;  ///< Reflectance along the normal, in [0, 1].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const { return SchlickBsdf{r0(at)}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] bool needs_coordinates() const { return r0.textured(); }
};

/// Rough diffuse matter.
struct OrenNayarMaterial {
  SpectralTexture reflectance;  ///< In [0, 1].
  double sigma_deg;             ///< Standard deviation of the facets' slopes, in [0, 90].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
};

/// The exercises' cos^a, of the light's direction alone or of both.
struct CosinePowerMaterial {
  SpectralTexture reflectance;  ///< Along the normal, in [0, 1].
  double exponent;              ///< In [0, 1e4].
  bool reciprocal;              ///< Of both.

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
};

/// Phong's highlight.
struct PhongMaterial {
  SpectralTexture reflectance;  ///< In [0, 1].
  double exponent;              ///< In [0, 1e4].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
};

/// What throws light back to where it comes from.
struct RetroreflectorMaterial {
  SpectralTexture reflectance;  ///< Along the normal, in [0, 1].
  double exponent;              ///< In [0, 1e4].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
  [[nodiscard]] bool needs_coordinates() const { return reflectance.textured(); }
};

}  // namespace abbe

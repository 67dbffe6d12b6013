#pragma once

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/model/opaque.h"

namespace abbe {

/// The ideal mirror, which reflects `reflectance` at every angle.
struct MirrorMaterial : OpaqueSurface {
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const { return MirrorBsdf{reflectance(at)}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
};

/// A mirror by Schlick's approximation; `reflectance` is that along the normal.
struct SchlickMaterial : OpaqueSurface {
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const { return SchlickBsdf{reflectance(at)}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
};

/// Rough diffuse matter; `reflectance` is that of its facets.
struct OrenNayarMaterial : OpaqueSurface {
  double sigma_deg;  ///< Standard deviation of the facets' slopes, in [0, 90].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// The exercises' cos^a, of the light's direction alone or of both; `reflectance` is that along the normal.
struct CosinePowerMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].
  bool reciprocal;  ///< Of both.

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// Phong's highlight.
struct PhongMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// What throws light back to where it comes from; `reflectance` is that along the normal.
struct RetroreflectorMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

}  // namespace abbe

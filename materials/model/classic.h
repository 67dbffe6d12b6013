#pragma once

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/model/opaque.h"

namespace abbe {

/// The ideal mirror with the same `reflectance` at every angle.
struct MirrorMaterial : OpaqueSurface {
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const { return MirrorBsdf{reflectance(at)}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
};

/// A mirror by Schlick's approximation; `reflectance` is its value along the normal.
struct SchlickMaterial : OpaqueSurface {
  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const { return SchlickBsdf{reflectance(at)}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
};

/// A rough diffuse surface; `reflectance` is that of its facets.
struct OrenNayarMaterial : OpaqueSurface {
  double sigma_deg;  ///< Standard deviation of the facets' slopes [degrees], in [0, 90].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// A power of the cosine of the light's direction, or of the cosines of both directions; `reflectance` is its
/// value along the normal.
struct CosinePowerMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].
  bool reciprocal;  ///< True if the cosines of both directions count.

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// Phong's highlight as a BRDF.
struct PhongMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// A retroreflector; `reflectance` is its value along the normal.
struct RetroreflectorMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

}  // namespace abbe

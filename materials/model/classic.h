#pragma once

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/lookup.h"
#include "materials/model/opaque.h"

namespace abbe {

// Formulas give the BRDF [1/sr]: rho is the material's `reflectance`; theta_i and theta_o are the angles of
// the light and the viewer with the normal. `SurfaceModel` describes the member functions.

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

/// A rough diffuse surface by `OrenNayarBsdf`; `reflectance` is that of its facets.
struct OrenNayarMaterial : OpaqueSurface {
  double sigma_deg;  ///< Standard deviation of the facets' slopes [degrees], in [0, 90].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// BRDF rho/pi cos^a theta_i, or if `reciprocal`, rho (a + 2)/(2 pi) cos^a theta_i cos^a theta_o, with the
/// exponent a. rho is the directional-hemispherical reflectance along the normal.
struct CosinePowerMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].
  bool reciprocal;  ///< True if the cosines of both directions are factors.

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// Phong's highlight as a BRDF, rho (n + 1)/(2 pi) cos^n alpha/cos theta_i, with the exponent n. alpha is the
/// angle between the viewer and the mirror direction of the light. rho is the directional-hemispherical
/// reflectance along the normal. The model is not reciprocal, and its albedo is unbounded towards grazing
/// incidence.
struct PhongMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// A retroreflector with the BRDF rho (n + 2)/(2 pi) cos^n alpha, with the exponent n. alpha is the angle
/// between the light and the viewer. rho is the directional-hemispherical reflectance along the normal.
struct RetroreflectorMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].

  [[nodiscard]] Bsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

}  // namespace abbe

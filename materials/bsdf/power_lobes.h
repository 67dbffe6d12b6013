#pragma once

#include <optional>
#include <variant>

#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/index/relative_index.h"

namespace abbe {

/// Models made of powers of a cosine, for teaching. Both sides reflect alike. k_i points to the light and k_o
/// to the viewer, at the angles theta_i and theta_o to the normal. In radiance mode k_i is wi, in power mode
/// it is wo; models that are not reciprocal depend on it. Formulas give f [1/sr], with rho the member
/// `reflectance`. Samples below the surface are empty.

/// A lobe about the normal, with a the exponent [Marschner2021, ch. 14, exercises]:
///     not `Reciprocal`: rho/pi             cos^a theta_i,
///     `Reciprocal`:     rho (a + 2)/(2 pi) cos^a theta_i cos^a theta_o.
/// rho is the directional-hemispherical reflectance for light along the normal, where it is largest.
template <bool Reciprocal>
struct CosinePowerBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;
  static constexpr bool kGlossy = true;
  static constexpr bool kReciprocal = Reciprocal;  ///< True if f(wo, wi) = f(wi, wo).

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
};

/// Phong's highlight as a BRDF, C cos^n alpha/cos theta_i with C = rho (n + 1)/(2 pi). n is the exponent,
/// alpha the angle between k_o and the mirror direction of k_i. rho is the directional-hemispherical
/// reflectance for light along the normal. The model is not reciprocal. Its albedo grows without bound
/// towards grazing incidence, where cos theta_i is limited to 1e-6 or more. [Phong1975]
struct PhongBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;
  static constexpr bool kGlossy = true;
  static constexpr bool kReciprocal = false;  ///< False because f(wo, wi) differs from f(wi, wo).
  static constexpr bool kConserving = false;  ///< False because more light may leave than arrives.

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
};

/// A retroreflector, C (k_i . k_o)^n where the product is positive, with n the exponent. Its
/// directional-hemispherical reflectance is largest along the normal, where the maxima of the lobe and of the
/// cosine coincide. C = rho (n + 2)/(2 pi) makes it rho there. [Marschner2021, ch. 14, exercises]
struct RetroreflectorBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;
  static constexpr bool kGlossy = true;

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
};

// Formulas give the BRDF [1/sr]: rho is the material's `reflectance`; theta_i and theta_o are the angles of
// the light and the viewer with the normal. `SurfaceModel` describes the member functions.

/// BRDF rho/pi cos^a theta_i, or if `reciprocal`, rho (a + 2)/(2 pi) cos^a theta_i cos^a theta_o, with the
/// exponent a. rho is the directional-hemispherical reflectance along the normal.
struct CosinePowerMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].
  bool reciprocal;  ///< True if the cosines of both directions are factors.

  [[nodiscard]] std::variant<CosinePowerBsdf<false>, CosinePowerBsdf<true>> bsdf(
      const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// Phong's highlight as a BRDF, rho (n + 1)/(2 pi) cos^n alpha/cos theta_i, with the exponent n. alpha is the
/// angle between the viewer and the mirror direction of the light. rho is the directional-hemispherical
/// reflectance along the normal. The model is not reciprocal, and its albedo is unbounded towards grazing
/// incidence.
struct PhongMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].

  [[nodiscard]] PhongBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// A retroreflector with the BRDF rho (n + 2)/(2 pi) cos^n alpha, with the exponent n. alpha is the angle
/// between the light and the viewer. rho is the directional-hemispherical reflectance along the normal.
struct RetroreflectorMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].

  [[nodiscard]] RetroreflectorBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

}  // namespace abbe

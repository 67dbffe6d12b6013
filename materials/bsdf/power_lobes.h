#pragma once

#include <optional>

#include "materials/bsdf/event.h"

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
  static constexpr bool kReciprocal = Reciprocal;  ///< True if f(wo, wi) = f(wi, wo).

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// Phong's highlight as a BRDF, C cos^n alpha/cos theta_i with C = rho (n + 1)/(2 pi). n is the exponent,
/// alpha the angle between k_o and the mirror direction of k_i. rho is the directional-hemispherical
/// reflectance for light along the normal. The model is not reciprocal. Its albedo grows without bound
/// towards grazing incidence, where cos theta_i is limited to 1e-6 or more. [Phong1975]
struct PhongBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;
  static constexpr bool kReciprocal = false;  ///< False because f(wo, wi) differs from f(wi, wo).
  static constexpr bool kConserving = false;  ///< False because more light may leave than arrives.

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// A retroreflector, C (k_i . k_o)^n where the product is positive, with n the exponent. Its
/// directional-hemispherical reflectance is largest along the normal, where the maxima of the lobe and of the
/// cosine coincide. C = rho (n + 2)/(2 pi) makes it rho there. [Marschner2021, ch. 14, exercises]
struct RetroreflectorBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe

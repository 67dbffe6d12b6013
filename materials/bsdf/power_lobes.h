#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// Models made of powers of a cosine, for teaching. Both sides reflect alike. k_i points to the light and k_o
/// to the viewer; TransportMode distinguishes them in models that are not reciprocal.

/// The lobe C cos^a theta_i or, if `Reciprocal`, C cos^a theta_i cos^a theta_o. C is rho/pi or rho (a + 2)/(2
/// pi), where rho is the reflectance along the normal, the largest one. [Marschner2021, ch. 14, exercises]
template <bool Reciprocal>
struct CosinePowerBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;
  static constexpr bool kReciprocal = Reciprocal;

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// Phong's highlight as a BRDF, C cos^n alpha/cos theta_i with C = rho (n + 1)/(2 pi). alpha is the angle
/// between k_o and the mirror direction of k_i. It is not reciprocal, and its albedo is unbounded towards
/// grazing incidence. [Phong1975]
struct PhongBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;
  static constexpr bool kReciprocal = false;
  static constexpr bool kConserving = false;

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// A retroreflector, C (k_i . k_o)^n where the product is positive. Its directional-hemispherical reflectance
/// is largest along the normal, where the maxima of the lobe and of the cosine coincide. C = rho (n + 2)/(2
/// pi) makes it rho there. [Marschner2021, ch. 14, exercises]
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

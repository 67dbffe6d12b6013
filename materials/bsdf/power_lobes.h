#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// Models made of powers of a cosine, kept for what they teach; both sides alike. k_i is where light comes
/// from and k_o where it is seen from: models that break reciprocity tell them apart by the TransportMode.

/// C cos^a theta_i, or C cos^a theta_i cos^a theta_o when `BothWays`: only the latter may be reversed. With
/// rho the reflectance of light along the normal, which is the largest, C is rho/pi, or rho (a + 2)/(2 pi).
/// [Marschner2021, ch. 14, exercises]
template <bool BothWays>
struct CosinePowerBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;
  static constexpr bool kReciprocal = BothWays;

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// Phong's highlight as a scattering function, C cos^n alpha/cos theta_i with alpha between k_o and the
/// mirror's direction of k_i and C = rho (n + 1)/(2 pi). It cannot be reversed, and at grazing incidence more
/// leaves than arrives, without bound. [Phong1975]
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

/// A retroreflector, C (k_i . k_o)^n where that is positive. The directional-hemispherical reflectance is the
/// largest along the normal, as a convolution of two functions that fall away from their middles is where
/// these meet: C (n + 2)/(2 pi) makes it rho there. [Marschner2021, ch. 14, exercises]
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

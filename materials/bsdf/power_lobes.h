#pragma once

#include <optional>
#include <variant>

#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/index/relative_index.h"

namespace abbe {

/// Models made of powers of a cosine, for teaching. Both sides reflect alike. Formulas give f [1/sr], with
/// rho the member `reflectance` and a the exponent. rho is the directional-hemispherical reflectance for
/// light along the normal. k_i points to the light and k_o to the viewer, at the angles theta_i and theta_o
/// to the normal. In radiance mode k_i is wi, in power mode it is wo; models that are not reciprocal depend
/// on it.
enum class PowerLobe {
  /// rho/pi cos^a theta_i, a lobe about the normal that is not reciprocal. [Marschner2021, ch. 14, exercises]
  cosine,
  /// rho (a + 2)/(2 pi) cos^a theta_i cos^a theta_o. [Marschner2021, ch. 14, exercises]
  reciprocal_cosine,
  /// Phong's highlight as a BRDF, rho (a + 1)/(2 pi) cos^a alpha/cos theta_i. alpha is the angle between k_o
  /// and the mirror direction of k_i. The model is not reciprocal. Its albedo grows without bound towards
  /// grazing incidence, where cos theta_i is limited to 1e-6 or more. [Phong1975]
  phong,
  /// rho (a + 2)/(2 pi) (k_i . k_o)^a where the product is positive. The reflectance is largest along the
  /// normal, where the maxima of the lobe and of the cosine coincide. [Marschner2021, ch. 14, exercises]
  retroreflector
};

/// Samples below the surface are empty.
template <PowerLobe Lobe>
struct PowerLobeBsdf {
  static constexpr bool kGlossy = true;
  /// True if f(wo, wi) = f(wi, wo).
  static constexpr bool kReciprocal =
      Lobe == PowerLobe::reciprocal_cosine || Lobe == PowerLobe::retroreflector;
  /// False if more light may leave than arrives.
  static constexpr bool kConserving = Lobe != PowerLobe::phong;

  SampledSpectrum reflectance;
  float exponent;  ///< In [0, 1e4].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
};

template <bool Reciprocal>
using CosinePowerBsdf = PowerLobeBsdf<Reciprocal ? PowerLobe::reciprocal_cosine : PowerLobe::cosine>;
using PhongBsdf = PowerLobeBsdf<PowerLobe::phong>;
using RetroreflectorBsdf = PowerLobeBsdf<PowerLobe::retroreflector>;

/// A surface that scatters by `Model`.
template <typename Model>
struct PowerLobeMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].

  [[nodiscard]] Model bsdf(const SurfaceLookup& at) const {
    return {reflectance(at), static_cast<float>(exponent)};
  }
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};
using PhongMaterial = PowerLobeMaterial<PhongBsdf>;
using RetroreflectorMaterial = PowerLobeMaterial<RetroreflectorBsdf>;

/// A lobe about the normal.
struct CosinePowerMaterial : OpaqueSurface {
  double exponent;  ///< In [0, 1e4].
  bool reciprocal;  ///< True if the cosines of both directions are factors.

  [[nodiscard]] std::variant<CosinePowerBsdf<false>, CosinePowerBsdf<true>> bsdf(
      const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

}  // namespace abbe

#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// A rough diffuse surface, with the same properties on both sides: Fujii's form of the Oren-Nayar model. It
/// loses energy, so a lobe for light scattered repeatedly among the facets is added. A white surface reflects
/// all light. [Portsmouth2025]
struct OrenNayarBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;

  SampledSpectrum reflectance;  ///< Reflectance of the facets, in [0, 1].
  float roughness;              ///< In [0, 1]; 0 is Lambertian.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// Roughness of facets whose slopes have the standard deviation `sigma_deg` [degrees], in [0, 90]. It is 0
/// for flat surfaces and below 0.8: B/A in the qualitative model of [OrenNayar1994].
[[nodiscard]] float oren_nayar_roughness(double sigma_deg);

}  // namespace abbe

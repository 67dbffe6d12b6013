#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// A rough diffuse surface that throws light back, both sides alike: Oren and Nayar's model as Fujii writes
/// it, which reflects less than arrives, and a lobe for the light scattered on among the facets that makes up
/// for it: white matter returns all. [Portsmouth2025]
struct OrenNayarBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;

  SampledSpectrum reflectance;
  float roughness;  ///< In [0, 1]; 0 is Lambert's.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// The roughness for facets whose slopes have the standard deviation `sigma_deg`: what B is to A in the
/// qualitative model of [OrenNayar1994].
[[nodiscard]] float oren_nayar_roughness(double sigma_deg);

}  // namespace abbe

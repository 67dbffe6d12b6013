#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// A Lambertian ground under a clear smooth coat, alike on both sides: the coat reflects in the mirror's
/// direction; what it lets in is scattered by the ground, thrown back by the coat from within and scattered
/// again, any number of times, and leaves spread,
///
///   f = T(o) T(i) rho/(n^2 (1 - rho r) pi),
///
/// T being what Fresnel's equations let pass, rho the reflectance of the ground, r that of the coat for
/// diffuse light from within. Energy is kept for rho = 1. [Saunderson1942]
struct CoatedDiffuseBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = true;

  SampledSpectrum n;       ///< Of the coat, relative to the outside, 1 or more.
  SampledSpectrum ground;  ///< rho/(n^2 (1 - rho r)).
  bool dispersive;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] SampledSpectrum delta_probability(const Imath::V3f& wo) const;
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// The model at one packet, from the index `n` of the coat, the ground's reflectance `rho` and `inner`, the
/// coat's reflectance for diffuse light from within.
[[nodiscard]] inline CoatedDiffuseBsdf coated_diffuse(const SampledSpectrum& n, const SampledSpectrum& rho,
                                                      const SampledSpectrum& inner, bool dispersive) {
  return {n, rho / (n * n * (SampledSpectrum(1) - rho * inner)), dispersive};
}

}  // namespace abbe

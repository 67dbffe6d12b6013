#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// A Lambertian ground under a transparent smooth coat, with the same properties on both sides. The coat
/// reflects specularly. The ground scatters the light that enters; the coat reflects it internally any number
/// of times before it leaves diffusely:
///
///   f = T(o) T(i) rho/(n^2 (1 - rho r) pi).
///
/// n is the index of the coat relative to the outside, and T its Fresnel transmittance. rho is the
/// reflectance of the ground, and r the internal diffuse reflectance of the coat. The model conserves energy
/// for rho = 1. [Saunderson1942]
struct CoatedDiffuseBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = true;

  SampledSpectrum n;       ///< Index of the coat relative to the outside, 1 or more.
  SampledSpectrum ground;  ///< rho/(n^2 (1 - rho r)).
  bool dispersive;         ///< True if n may differ between wavelengths.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] SampledSpectrum delta_probability(const Imath::V3f& wo) const;
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// The model at one packet. `n` is the index of the coat relative to the outside, `rho` the reflectance of
/// the ground, in [0, 1]. `inner` is the internal diffuse reflectance of the coat
/// (`diffuse_reflectance_inside`); rho * inner must be below 1.
[[nodiscard]] inline CoatedDiffuseBsdf coated_diffuse(const SampledSpectrum& n, const SampledSpectrum& rho,
                                                      const SampledSpectrum& inner, bool dispersive) {
  return {n, rho / (n * n * (SampledSpectrum(1) - rho * inner)), dispersive};
}

}  // namespace abbe

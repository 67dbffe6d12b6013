#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/bsdf/warp.h"
#include "materials/index/relative_index.h"

namespace abbe {

/// Lambertian reflection on the side of `wo`. Both sides reflect alike.
struct DiffuseBsdf {
  SampledSpectrum reflectance;  ///< Directional-hemispherical reflectance, in [0, 1].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
};

// Inline, because Lambertian surfaces are so frequent that calls would cost more than the scattering.

// f = reflectance/pi, sampled with pdf cos/pi, so the weight is the reflectance for every direction.

inline std::optional<BsdfSample> DiffuseBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int /*hero*/,
                                                     TransportMode /*mode*/) const {
  Imath::V3f wi = cosine_hemisphere(u.direction);
  if (wo.z == 0 || wi.z == 0) return std::nullopt;
  const float pdf = wi.z * std::numbers::inv_pi_v<float>;
  wi.z = std::copysign(wi.z, wo.z);
  return BsdfSample{.wi = wi, .weight = reflectance, .pdf = pdf};
}

inline SampledSpectrum DiffuseBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi,
                                         TransportMode /*mode*/) const {
  return wo.z * wi.z > 0 ? reflectance * std::numbers::inv_pi_v<float> : SampledSpectrum();
}

inline SampledSpectrum DiffuseBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  return SampledSpectrum(wo.z * wi.z > 0 ? std::abs(wi.z) * std::numbers::inv_pi_v<float> : 0.0F);
}

/// A rough diffuse surface, with the same properties on both sides: Fujii's form of the Oren-Nayar model. It
/// loses energy, so a lobe for light scattered repeatedly among the facets is added. A white surface reflects
/// all light. [Portsmouth2025]
struct OrenNayarBsdf {
  SampledSpectrum reflectance;  ///< Reflectance of the facets, in [0, 1].
  float roughness;              ///< In [0, 1]; 0 is Lambertian.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
};

/// Roughness of facets whose slopes have the standard deviation `sigma_deg` [degrees], in [0, 90]. It is 0
/// for flat surfaces and below 0.8: B/A in the qualitative model of [OrenNayar1994].
[[nodiscard]] float oren_nayar_roughness(double sigma_deg);

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
  SampledSpectrum n;       ///< Index of the coat relative to the outside, 1 or more.
  SampledSpectrum ground;  ///< rho/(n^2 (1 - rho r)).
  bool dispersive;         ///< True if n may differ between wavelengths.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] SampledSpectrum delta_probability(const Imath::V3f& wo) const;
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane) const;
};

/// The model with these n and rho; `inner` is r (`diffuse_reflectance_inside`). rho * inner must be below 1.
[[nodiscard]] inline CoatedDiffuseBsdf coated_diffuse(const SampledSpectrum& n, const SampledSpectrum& rho,
                                                      const SampledSpectrum& inner, bool dispersive) {
  return {n, rho / (n * n * (SampledSpectrum(1) - rho * inner)), dispersive};
}

/// A Lambertian surface; `reflectance` is its hemispherical reflectance.
struct DiffuseMaterial : OpaqueSurface {
  [[nodiscard]] DiffuseBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// A rough diffuse surface by `OrenNayarBsdf`; `reflectance` is that of its facets.
struct OrenNayarMaterial : OpaqueSurface {
  double sigma_deg;  ///< Standard deviation of the facets' slopes [degrees], in [0, 90].

  [[nodiscard]] OrenNayarBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.spread = true}; }
};

/// Internal diffuse reflectance (`diffuse_reflectance_inside`) of a transparent smooth coat of `index` in
/// air, every 1 nm from 300 to 1100 nm.
[[nodiscard]] Curve inner_reflectance(const RefractiveIndex& index);

/// A Lambertian ground under a smooth transparent coat, such as glazed or varnished paint; `reflectance` is
/// that of the uncoated ground.
struct CoatedDiffuseMaterial : OpaqueSurface {
  std::string index_name;
  RefractiveIndex index;  ///< Index of the coat: n in [1, 100), without k.
  /// Internal diffuse reflectance in air; other media have their own.
  Curve inner = inner_reflectance(index);

  [[nodiscard]] CoatedDiffuseBsdf bsdf(const SurfaceLookup& at) const;
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true, .spread = true}; }
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
  [[nodiscard]] static constexpr bool depends_on_outside() { return true; }
  [[nodiscard]] std::vector<IndexUse> indices() const { return {{&index_name, &index}}; }
};

}  // namespace abbe

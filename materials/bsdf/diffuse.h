#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "materials/bsdf/event.h"
#include "materials/bsdf/warp.h"

namespace abbe {

/// Lambertian reflection on the side of `wo`. Both sides reflect alike.
struct DiffuseBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;

  SampledSpectrum reflectance;  ///< Directional-hemispherical reflectance, in [0, 1].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

// These functions are inline: Lambertian surfaces are so frequent that calls would cost more than the
// scattering.

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

}  // namespace abbe

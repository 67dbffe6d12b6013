#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "materials/bsdf/event.h"
#include "materials/bsdf/warp.h"

namespace abbe {

/// Lambertian reflection on the side of the normal `wo` is on; both sides alike.
struct DiffuseBsdf {
  static constexpr bool kScatters = true;
  static constexpr bool kDelta = false;

  SampledSpectrum reflectance;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

// In line, as scattering off the commonest matter costs less than the calls would.

// f = reflectance/pi, drawn with density cos/pi: the weight is the reflectance for every direction.

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

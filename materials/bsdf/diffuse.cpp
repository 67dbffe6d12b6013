#include <cmath>
#include <numbers>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/warp.h"

namespace abbe {

// f = reflectance/pi, drawn with density cos/pi: the weight is the reflectance for every direction.

std::optional<BsdfSample> DiffuseBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int /*hero*/,
                                              TransportMode /*mode*/) const {
  Imath::V3f wi = cosine_hemisphere(u.direction);
  if (wo.z == 0 || wi.z == 0) return std::nullopt;
  const float pdf = wi.z * std::numbers::inv_pi_v<float>;
  wi.z = std::copysign(wi.z, wo.z);
  return BsdfSample{.wi = wi, .weight = reflectance, .pdf = pdf};
}

SampledSpectrum DiffuseBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode /*mode*/) const {
  return wo.z * wi.z > 0 ? reflectance * std::numbers::inv_pi_v<float> : SampledSpectrum();
}

SampledSpectrum DiffuseBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  return SampledSpectrum(wo.z * wi.z > 0 ? std::abs(wi.z) * std::numbers::inv_pi_v<float> : 0.0F);
}

}  // namespace abbe

#include "materials/bsdf/power_lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/warp.h"

namespace abbe {

namespace {

using Imath::V3f;

constexpr float kTwoPi = 2 * std::numbers::pi_v<float>;

// cos^n of the angle between two directions, 0 if it is obtuse, accurate also for narrow lobes.
float power_of_cosine(const V3f& a, const V3f& b, float n) {
  const float versine = (a - b).length2() / 2;
  return versine < 1 ? std::exp(n * std::log1p(-versine)) : 0.0F;
}

/// Directions with pdf (n + 1)/(2 pi) cos^n about `axis`. Directions below the horizon get no light.
struct SampledLobe {
  V3f axis;
  float n;

  [[nodiscard]] float density(const V3f& w) const {
    if (!(w.z * axis.z > 0)) return 0;
    return (n + 1) / kTwoPi * power_of_cosine(w, axis, n);
  }

  [[nodiscard]] std::optional<V3f> sample(const Imath::V2f& u) const {
    const float versine = -std::expm1(std::log1p(-u.x) / (n + 1));
    const float sine = std::sqrt(versine * (2 - versine));
    const V3f about_z(sine * std::cos(kTwoPi * u.y), sine * std::sin(kTwoPi * u.y), 1 - versine);
    // Reflect by the plane that maps z to the axis.
    const V3f across = V3f(0, 0, 1) - axis;
    const float length2 = across.length2();
    const V3f w = length2 > 0 ? about_z - across * (2 * about_z.dot(across) / length2) : about_z;
    if (!(w.z * axis.z > 0)) return std::nullopt;
    return w.normalized();
  }
};

// The direction of incident light.
const V3f& source(const V3f& wo, const V3f& wi, TransportMode mode) {
  return mode == TransportMode::radiance ? wi : wo;
}

// The lobe from which directions are sampled.
template <PowerLobe Lobe>
SampledLobe lobe_of(const PowerLobeBsdf<Lobe>& model, const V3f& wo) {
  if constexpr (Lobe == PowerLobe::phong) return {mirrored(wo), model.exponent};
  if constexpr (Lobe == PowerLobe::retroreflector) return {wo, model.exponent};
  return {V3f(0, 0, std::copysign(1.0F, wo.z)), 1 + (Lobe == PowerLobe::cosine ? 0 : model.exponent)};
}

}  // namespace

template <PowerLobe Lobe>
std::optional<BsdfSample> PowerLobeBsdf<Lobe>::sample(const V3f& wo, const BsdfRandom& u, int /*hero*/,
                                                      TransportMode mode) const {
  if (wo.z == 0) return std::nullopt;
  const SampledLobe lobe = lobe_of(*this, wo);
  const std::optional<V3f> wi = lobe.sample(u.direction);
  if (!wi) return std::nullopt;
  const float pdf = lobe.density(*wi);
  if (!(pdf > 0)) return std::nullopt;
  return BsdfSample{.wi = *wi, .weight = eval(wo, *wi, mode) * (std::abs(wi->z) / pdf), .pdf = pdf};
}

template <PowerLobe Lobe>
SampledSpectrum PowerLobeBsdf<Lobe>::eval(const V3f& wo, const V3f& wi, TransportMode mode) const {
  constexpr float kMinCosine = 1e-6F;  // bounds the unbounded BRDF
  if (!(wo.z * wi.z > 0)) return {};
  const float cos_i = std::abs(source(wo, wi, mode).z);
  switch (Lobe) {
    case PowerLobe::cosine:
      return reflectance * (2 / kTwoPi * std::pow(cos_i, exponent));
    case PowerLobe::reciprocal_cosine:
      return reflectance * ((exponent + 2) / kTwoPi * std::pow(wo.z * wi.z, exponent));
    case PowerLobe::phong:
      return reflectance * ((exponent + 1) / kTwoPi * power_of_cosine(mirrored(wo), wi, exponent) /
                            std::max(cos_i, kMinCosine));
    case PowerLobe::retroreflector:
      return reflectance * ((exponent + 2) / kTwoPi * power_of_cosine(wo, wi, exponent));
  }
  return {};
}

template <PowerLobe Lobe>
SampledSpectrum PowerLobeBsdf<Lobe>::pdf(const V3f& wo, const V3f& wi) const {
  return SampledSpectrum(lobe_of(*this, wo).density(wi));
}

template struct PowerLobeBsdf<PowerLobe::cosine>;
template struct PowerLobeBsdf<PowerLobe::reciprocal_cosine>;
template struct PowerLobeBsdf<PowerLobe::phong>;
template struct PowerLobeBsdf<PowerLobe::retroreflector>;

std::variant<CosinePowerBsdf<false>, CosinePowerBsdf<true>> CosinePowerMaterial::bsdf(
    const SurfaceLookup& at) const {
  const SampledSpectrum rho = reflectance(at);
  const auto a = static_cast<float>(exponent);
  if (reciprocal) return CosinePowerBsdf<true>{rho, a};
  return CosinePowerBsdf<false>{rho, a};
}

}  // namespace abbe

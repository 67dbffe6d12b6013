#include "materials/bsdf/power_lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/event.h"
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
struct PowerLobe {
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

template <typename Model>
std::optional<BsdfSample> sample_lobe(const Model& model, const PowerLobe& lobe, const V3f& wo,
                                      const BsdfRandom& u, TransportMode mode) {
  if (wo.z == 0) return std::nullopt;
  const std::optional<V3f> wi = lobe.sample(u.direction);
  if (!wi) return std::nullopt;
  const float pdf = lobe.density(*wi);
  if (!(pdf > 0)) return std::nullopt;
  return BsdfSample{.wi = *wi, .weight = model.eval(wo, *wi, mode) * (std::abs(wi->z) / pdf), .pdf = pdf};
}

// The direction of incident light.
const V3f& source(const V3f& wo, const V3f& wi, TransportMode mode) {
  return mode == TransportMode::radiance ? wi : wo;
}

bool same_side(const V3f& wo, const V3f& wi) {
  return wo.z * wi.z > 0;
}

template <bool Reciprocal>
PowerLobe lobe_of(const CosinePowerBsdf<Reciprocal>& model, const V3f& wo) {
  return {V3f(0, 0, std::copysign(1.0F, wo.z)), 1 + (Reciprocal ? model.exponent : 0)};
}
PowerLobe lobe_of(const PhongBsdf& model, const V3f& wo) {
  return {mirrored(wo), model.exponent};
}
PowerLobe lobe_of(const RetroreflectorBsdf& model, const V3f& wo) {
  return {wo, model.exponent};
}

}  // namespace

template <bool Reciprocal>
std::optional<BsdfSample> CosinePowerBsdf<Reciprocal>::sample(const V3f& wo, const BsdfRandom& u,
                                                              int /*hero*/, TransportMode mode) const {
  return sample_lobe(*this, lobe_of(*this, wo), wo, u, mode);
}
template <bool Reciprocal>
SampledSpectrum CosinePowerBsdf<Reciprocal>::eval(const V3f& wo, const V3f& wi, TransportMode mode) const {
  if (!same_side(wo, wi)) return {};
  if constexpr (Reciprocal)
    return reflectance * ((exponent + 2) / kTwoPi * std::pow(wo.z * wi.z, exponent));
  else
    return reflectance * (2 / kTwoPi * std::pow(std::abs(source(wo, wi, mode).z), exponent));
}
template <bool Reciprocal>
SampledSpectrum CosinePowerBsdf<Reciprocal>::pdf(const V3f& wo, const V3f& wi) const {
  return SampledSpectrum(lobe_of(*this, wo).density(wi));
}
template struct CosinePowerBsdf<false>;
template struct CosinePowerBsdf<true>;

std::optional<BsdfSample> PhongBsdf::sample(const V3f& wo, const BsdfRandom& u, int /*hero*/,
                                            TransportMode mode) const {
  return sample_lobe(*this, lobe_of(*this, wo), wo, u, mode);
}
SampledSpectrum PhongBsdf::eval(const V3f& wo, const V3f& wi, TransportMode mode) const {
  constexpr float kMinCosine = 1e-6F;  // bounds the unbounded BRDF
  if (!same_side(wo, wi)) return {};
  const float cos_i = std::max(std::abs(source(wo, wi, mode).z), kMinCosine);
  return reflectance * ((exponent + 1) / kTwoPi * power_of_cosine(mirrored(wo), wi, exponent) / cos_i);
}
SampledSpectrum PhongBsdf::pdf(const V3f& wo, const V3f& wi) const {
  return SampledSpectrum(lobe_of(*this, wo).density(wi));
}

std::optional<BsdfSample> RetroreflectorBsdf::sample(const V3f& wo, const BsdfRandom& u, int /*hero*/,
                                                     TransportMode mode) const {
  return sample_lobe(*this, lobe_of(*this, wo), wo, u, mode);
}
SampledSpectrum RetroreflectorBsdf::eval(const V3f& wo, const V3f& wi, TransportMode /*mode*/) const {
  if (!same_side(wo, wi)) return {};
  return reflectance * ((exponent + 2) / kTwoPi * power_of_cosine(wo, wi, exponent));
}
SampledSpectrum RetroreflectorBsdf::pdf(const V3f& wo, const V3f& wi) const {
  return SampledSpectrum(lobe_of(*this, wo).density(wi));
}

std::variant<CosinePowerBsdf<false>, CosinePowerBsdf<true>> CosinePowerMaterial::bsdf(
    const SurfaceLookup& at) const {
  const SampledSpectrum rho = reflectance(at);
  const auto a = static_cast<float>(exponent);
  if (reciprocal) return CosinePowerBsdf<true>{rho, a};
  return CosinePowerBsdf<false>{rho, a};
}

PhongBsdf PhongMaterial::bsdf(const SurfaceLookup& at) const {
  return {reflectance(at), static_cast<float>(exponent)};
}

RetroreflectorBsdf RetroreflectorMaterial::bsdf(const SurfaceLookup& at) const {
  return {reflectance(at), static_cast<float>(exponent)};
}

}  // namespace abbe

#include "materials/bsdf/rough_diffuse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/diffuse.h"

namespace abbe {
namespace {

constexpr float kInvPi = std::numbers::inv_pi_v<float>;

// A = 1/(1 + (1/2 - 2/(3 pi)) r), the coefficient of the Lambertian term. B = r A is the coefficient of the
// azimuthal term. [Portsmouth2025]
float lambert_weight(float roughness) {
  return 1 / (1 + (0.5F - 2 * kInvPi / 3) * roughness);
}

// Directional albedo of white facets without the added lobe. [Portsmouth2025]
float single_albedo(float cosine, float roughness) {
  const float c = std::clamp(cosine, 0.0F, 1.0F);
  const float s = std::sqrt((1 - c) * (1 + c));
  const float s3 = s * s * s;
  // (1 - s^3)/c, rewritten by 1 - s^6 = c^2 (1 + s^2 + s^4), because numerator and denominator may both
  // vanish.
  const float rest = c * (1 + s * s + s * s3) / (1 + s3);
  const float g = s * (std::acos(c) - s * c) + 2.0F / 3 * s * (rest - 1);
  return lambert_weight(roughness) * (1 + roughness * kInvPi * g);
}

// Diffuse reflectance of white facets without the added lobe. [Portsmouth2025]
float mean_single_albedo(float roughness) {
  return lambert_weight(roughness) * (1 + roughness * (2.0F / 3 - 28 * kInvPi / 15));
}

}  // namespace

float oren_nayar_roughness(double sigma_deg) {
  const double sigma = sigma_deg * std::numbers::pi / 180;
  const double a = 1 - 0.5 * sigma * sigma / (sigma * sigma + 0.33);
  const double b = 0.45 * sigma * sigma / (sigma * sigma + 0.09);
  return static_cast<float>(b / a);
}

SampledSpectrum OrenNayarBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi,
                                    TransportMode /*mode*/) const {
  if (!(wo.z * wi.z > 0)) return {};
  const float cos_o = std::abs(wo.z);
  const float cos_i = std::abs(wi.z);
  const float s =
      wo.x * wi.x + wo.y * wi.y;  // cosine of the azimuth between both directions, times both sines
  const float t = s > 0 ? std::max(cos_o, cos_i) : 1.0F;
  const float once = lambert_weight(roughness) * (1 + roughness * s / t);
  const float mean = mean_single_albedo(roughness);
  const float lost = 1 - mean;
  if (!(lost > 0)) return reflectance * (once * kInvPi);
  const float lobe = (1 - single_albedo(cos_o, roughness)) * (1 - single_albedo(cos_i, roughness)) / lost;
  const auto f = [&](float rho) {
    return rho * (once + rho * mean / (1 - rho * lost) * std::max(lobe, 0.0F)) * kInvPi;
  };
  return SampledSpectrum::map(reflectance, f);
}

// Directions are sampled as for a Lambertian surface.
std::optional<BsdfSample> OrenNayarBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                TransportMode mode) const {
  auto s = DiffuseBsdf{SampledSpectrum(1)}.sample(wo, u, hero, mode);
  if (s) s->weight = eval(wo, s->wi, mode) * std::numbers::pi_v<float>;
  return s;
}

SampledSpectrum OrenNayarBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  return DiffuseBsdf{SampledSpectrum(1)}.pdf(wo, wi);
}

}  // namespace abbe

#include "materials/bsdf/diffuse.h"

#include <algorithm>

#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"

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

// Fractions of light that the coat reflects and lets in, R and T, at an angle of cosine cos_i.
struct Passage {
  SampledSpectrum reflected, let_in;
};
Passage through(const CoatedDiffuseBsdf& bsdf, float cos_i) {
  const auto fresnel = [c = std::min(std::abs(cos_i), 1.0F)](float n) { return fresnel_dielectric(c, n); };
  if (!bsdf.dispersive) {
    const FresnelPower<float> f = fresnel(bsdf.n[0]);
    return {SampledSpectrum(f.R()), SampledSpectrum(f.transmitted())};
  }
  SampledSpectrum::Values reflected;
  SampledSpectrum::Values let_in;
  for (std::size_t j = 0; j < kLanes; ++j) {
    const FresnelPower<float> f = fresnel(bsdf.n[static_cast<int>(j)]);
    reflected[j] = f.R();
    let_in[j] = f.transmitted();
  }
  return {SampledSpectrum(reflected), SampledSpectrum(let_in)};
}

// Probability of sampling the diffuse lobe: approximately its fraction of the reflected power. The diffuse
// albedo is let_in * ground * (1 - r_outside); the last factor is neglected.
SampledSpectrum spread_probability(const CoatedDiffuseBsdf& bsdf, const Passage& passage) {
  const auto part = [](float spread, float mirrored) {
    return mirrored > 0 ? spread / (spread + mirrored) : 1.0F;
  };
  return SampledSpectrum::map(passage.let_in * bsdf.ground, passage.reflected, part);
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

std::optional<BsdfSample> CoatedDiffuseBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                    TransportMode /*mode*/) const {
  if (wo.z == 0) return std::nullopt;
  const Passage passage = through(*this, wo.z);
  const SampledSpectrum spread = spread_probability(*this, passage);
  const float mirror_probability = 1 - spread[hero];
  if (u.lobe < mirror_probability)
    return BsdfSample{.wi = mirrored(wo),
                      .weight = passage.reflected * (1 / mirror_probability),
                      .lane_pdf = (SampledSpectrum(1) - spread) * (1 / mirror_probability),
                      .pdf = mirror_probability,
                      .delta = true};
  Imath::V3f wi = cosine_hemisphere(u.direction);
  if (wi.z == 0) return std::nullopt;
  const float pdf = wi.z * std::numbers::inv_pi_v<float> * spread[hero];
  wi.z = std::copysign(wi.z, wo.z);
  const float per_spread = 1 / spread[hero];
  return BsdfSample{.wi = wi,
                    .weight = passage.let_in * through(*this, wi.z).let_in * ground * per_spread,
                    .lane_pdf = spread * per_spread,
                    .pdf = pdf};
}

SampledSpectrum CoatedDiffuseBsdf::delta_probability(const Imath::V3f& wo) const {
  return SampledSpectrum(1) - spread_probability(*this, through(*this, wo.z));
}

SampledSpectrum CoatedDiffuseBsdf::delta_power(const Imath::V3f& wo, bool is_through) const {
  return is_through ? SampledSpectrum() : through(*this, wo.z).reflected;
}

std::optional<MuellerMatrix> CoatedDiffuseBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& /*wi*/,
                                                        bool delta, std::optional<int> lane) const {
  if (!delta) return std::nullopt;
  const float cos_i = std::min(std::abs(wo.z), 1.0F);
  return mueller_of_surface(wo, dispersive ? lane : std::optional(0),
                            [&](int j) { return reflection_mueller(cos_i, n[j], 0.0F); });
}

SampledSpectrum CoatedDiffuseBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi,
                                        TransportMode /*mode*/) const {
  if (!(wo.z * wi.z > 0)) return {};
  return through(*this, wo.z).let_in * through(*this, wi.z).let_in * ground * std::numbers::inv_pi_v<float>;
}

SampledSpectrum CoatedDiffuseBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  if (!(wo.z * wi.z > 0)) return {};
  return spread_probability(*this, through(*this, wo.z)) * (std::abs(wi.z) * std::numbers::inv_pi_v<float>);
}

DiffuseBsdf DiffuseMaterial::bsdf(const SurfaceLookup& at) const {
  return {reflectance(at)};
}

OrenNayarBsdf OrenNayarMaterial::bsdf(const SurfaceLookup& at) const {
  return {reflectance(at), oren_nayar_roughness(sigma_deg)};
}

Curve inner_reflectance(const RefractiveIndex& index) {
  return each_nm([&](double nm) { return diffuse_reflectance_inside(index.n(nm)); });
}

CoatedDiffuseBsdf CoatedDiffuseMaterial::bsdf(const SurfaceLookup& at) const {
  const RelativeIndex coat = relative_index(index, at.outside, at.wavelengths_nm);
  const auto back = [](float n) { return static_cast<float>(diffuse_reflectance_inside(n)); };
  const SampledSpectrum r =
      at.outside == nullptr ? inner(at.wavelengths_nm) : SampledSpectrum::map(coat.n, back);
  return coated_diffuse(coat.n, reflectance(at), r, coat.dispersive);
}

std::optional<FresnelPower<double>> CoatedDiffuseMaterial::smooth_power(const SmoothLookup& at) const {
  return without_transmission(fresnel_dielectric(at.cos_i, index.n(at.wavelength_nm) / at.outside));
}

SmoothMueller CoatedDiffuseMaterial::smooth_mueller(const SmoothLookup& at) const {
  return {{reflection_mueller(at.cos_i, index.n(at.wavelength_nm) / at.outside, 0.0), {}}};
}

}  // namespace abbe

#include "materials/bsdf/coated_diffuse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/mirror.h"
#include "materials/bsdf/warp.h"
#include "materials/interface/fresnel.h"

namespace abbe {
namespace {

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

SampledSpectrum CoatedDiffuseBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi,
                                        TransportMode /*mode*/) const {
  if (!(wo.z * wi.z > 0)) return {};
  return through(*this, wo.z).let_in * through(*this, wi.z).let_in * ground * std::numbers::inv_pi_v<float>;
}

SampledSpectrum CoatedDiffuseBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  if (!(wo.z * wi.z > 0)) return {};
  return spread_probability(*this, through(*this, wo.z)) * (std::abs(wi.z) * std::numbers::inv_pi_v<float>);
}

}  // namespace abbe

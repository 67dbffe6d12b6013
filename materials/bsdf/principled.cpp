#include "materials/bsdf/principled.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/warp.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/microfacet.h"

namespace abbe {
namespace {

using Imath::V3f;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kCoatIndex = 1.5F;
constexpr auto kCoatStrength = static_cast<float>(kCoatScale);
constexpr auto kDullCoat = static_cast<float>(kDullCoatAlpha);
constexpr auto kGlossyCoat = static_cast<float>(kGlossyCoatAlpha);
constexpr float kCoatShadowing = 0.25F;  // alpha of the coat's masking and shadowing
constexpr int kCosines = 32;
constexpr int kSteps = 64;
constexpr float kTableError = 3e-3F;

// Schlick's factor (1 - cosine)^5.
float fifth_power(float cosine) {
  return schlick(std::clamp(cosine, 0.0F, 1.0F), 0.0F);
}

Microfacets<float> facets(float alpha) {
  return {FacetShape::ggx, alpha, alpha};
}

// Long-tailed distribution of the clear coat, gamma = 1. [Burley2012, eq. 4]
float coat_density(const V3f& h, float alpha) {
  const float a2 = alpha * alpha;
  return (1 - a2) / (-2 * kPi * std::log(alpha) * (h.x * h.x + h.y * h.y + a2 * h.z * h.z));
}

// Samples a facet with pdf D cos. [Burley2012, eq. 5]
V3f sample_coat(float alpha, const Imath::V2f& u) {
  const float a2 = alpha * alpha;
  const float sin2 = (std::pow(a2, 1 - u.x) - a2) / (1 - a2);
  const float sine = std::sqrt(std::clamp(sin2, 0.0F, 1.0F));
  return {sine * std::cos(2 * kPi * u.y), sine * std::sin(2 * kPi * u.y),
          std::sqrt(std::clamp(1 - sin2, 0.0F, 1.0F))};
}

// Diffuse factor without colour. At grazing angles it ranges from 1/2 when smooth to 5/2 when rough.
// [Burley2012, sec. 5.3]
float retro_diffuse(float roughness, float cos_o, float cos_i, float cos_d) {
  const float more = 2 * roughness * cos_d * cos_d - 0.5F;
  return (1 + more * fifth_power(cos_o)) * (1 + more * fifth_power(cos_i)) / kPi;
}

V3f above(const V3f& w) {
  return {w.x, w.y, std::abs(w.z)};
}

}  // namespace

// Two directions with z > 0 and the facet that mirrors one into the other.
struct Principled::Facet {
  V3f wo, wi, h;
  float cos_d, rise, per_facet;

  Facet(const V3f& o, const V3f& i)
      : wo(o),
        wi(i),
        h((o + i).normalized()),
        cos_d(std::min(h.dot(i), 1.0F)),
        rise(fifth_power(cos_d)),
        per_facet(1 / (4 * o.z * i.z)) {}
};

Principled::Principled(const PrincipledParameters& parameters)
    : parameters_(parameters),
      alpha_(std::max(static_cast<float>(kMinAlpha), parameters.roughness * parameters.roughness)),
      coat_alpha_(kDullCoat + (kGlossyCoat - kDullCoat) * parameters.clearcoat_gloss) {
  const float root = std::sqrt(0.08F * parameters.specular);
  n_ = (1 + root) / (1 - root);
  probability_ = {1 - parameters.metallic, std::max(parameters.metallic, 0.5F),
                  kCoatStrength * parameters.clearcoat};
  const float all = probability_[ground] + probability_[highlight] + probability_[coat];
  for (float& p : probability_) p /= all;
  for (int i = 0; i < kCosines; ++i) {
    const double root_cosine = std::max(1e-4, static_cast<double>(i) / (kCosines - 1));
    albedo_.push_back(integrated(direction_at(root_cosine * root_cosine, 0)));
  }
}

Principled::Terms Principled::value(Lobe lobe, const Facet& at) const {
  const float body = 1 - parameters_.metallic;
  if (lobe == ground)
    return {body * parameters_.sheen * at.rise,
            body * retro_diffuse(parameters_.roughness, at.wo.z, at.wi.z, at.cos_d)};
  if (lobe == coat) {
    const Microfacets<float> shadowing = facets(kCoatShadowing);
    return {kCoatStrength * parameters_.clearcoat * coat_density(at.h, coat_alpha_) * shadowing.G1(at.wo) *
                shadowing.G1(at.wi) * fresnel_dielectric(at.cos_d, kCoatIndex).R() * at.per_facet,
            0};
  }
  const Microfacets<float> surface = facets(alpha_);
  const float facing = surface.D(at.h) * at.per_facet / (1 + surface.lambda(at.wo) + surface.lambda(at.wi));
  return {(body * fresnel_dielectric(at.cos_d, n_).R() + parameters_.metallic * at.rise) * facing,
          parameters_.metallic * (1 - at.rise) * facing};
}

float Principled::density(Lobe lobe, const Facet& at) const {
  if (lobe == ground) return at.wi.z / kPi;
  const float per_facet = 1 / (4 * at.h.dot(at.wo));
  if (lobe == coat) return coat_density(at.h, coat_alpha_) * at.h.z * per_facet;
  return facets(alpha_).visible(at.wo, at.h) * per_facet;
}

std::optional<V3f> Principled::draw(Lobe lobe, const V3f& wo, const Imath::V2f& u) const {
  V3f wi = cosine_hemisphere(u);
  if (lobe != ground) {
    const V3f h = lobe == coat ? sample_coat(coat_alpha_, u) : facets(alpha_).sample_visible(wo, u);
    wi = (h * (2 * h.dot(wo)) - wo).normalized();
  }
  if (!(wi.z > 0)) return std::nullopt;
  return wi;
}

Principled::Terms Principled::unlimited(const V3f& wo, const V3f& wi) const {
  Terms f;
  if (!(wo.z > 0 && wi.z > 0)) return f;
  const Facet at(wo, wi);
  for (const Lobe lobe : kLobes) {
    if (!(probability_[lobe] > 0)) continue;
    const Terms part = value(lobe, at);
    f = {f.white + part.white, f.coloured + part.coloured};
  }
  return f;
}

float Principled::density(const V3f& wo, const V3f& wi) const {
  float sum = 0;
  if (!(wo.z > 0 && wi.z > 0)) return sum;
  const Facet at(wo, wi);
  for (const Lobe lobe : kLobes)
    if (probability_[lobe] > 0) sum += probability_[lobe] * density(lobe, at);
  return sum;
}

std::optional<V3f> Principled::draw(const V3f& wo, const BsdfRandom& u) const {
  if (u.lobe < probability_[ground]) return draw(ground, wo, u.direction);
  const bool coated = probability_[coat] > 0 && u.lobe >= probability_[ground] + probability_[highlight];
  return draw(coated ? coat : highlight, wo, u.direction);
}

// Integrates each lobe by the midpoint rule over the random numbers that sample it.
Principled::Terms Principled::integrated(const V3f& wo) const {
  Terms sum;
  for (const Lobe lobe : kLobes)
    for (int i = 0; i < kSteps * kSteps && probability_[lobe] > 0; ++i) {
      const int row = i / kSteps;
      const Imath::V2f u((static_cast<float>(i % kSteps) + 0.5F) / kSteps,
                         (static_cast<float>(row) + 0.5F) / kSteps);
      const auto wi = draw(lobe, wo, u);
      if (!wi) continue;
      const Facet at(wo, *wi);
      const Terms f = value(lobe, at);
      const float weight = wi->z / (density(lobe, at) * kSteps * kSteps);
      sum = {sum.white + f.white * weight, sum.coloured + f.coloured * weight};
    }
  return sum;
}

Principled::Terms Principled::albedo(float cosine) const {
  const float x = std::sqrt(std::clamp(cosine, 0.0F, 1.0F)) * (kCosines - 1);
  const auto i = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(kCosines - 2));
  const float t = x - static_cast<float>(i);
  const Terms& a = albedo_[i];
  const Terms& b = albedo_[i + 1];
  return {a.white + t * (b.white - a.white), a.coloured + t * (b.coloured - a.coloured)};
}

SampledSpectrum PrincipledBsdf::eval(const V3f& wo, const V3f& wi, TransportMode /*mode*/) const {
  if (!(wo.z * wi.z > 0)) return {};
  const Principled::Terms f = principled->unlimited(above(wo), above(wi));
  const Principled::Terms o = principled->albedo(std::abs(wo.z));
  const Principled::Terms i = principled->albedo(std::abs(wi.z));
  return SampledSpectrum::map(base, [&](float b) {
    const float largest = std::max(o.white + b * o.coloured, i.white + b * i.coloured);
    return (f.white + b * f.coloured) / std::max(1.0F, largest * (1 + kTableError));
  });
}

std::optional<BsdfSample> PrincipledBsdf::sample(const V3f& wo, const BsdfRandom& u, int /*hero*/,
                                                 TransportMode mode) const {
  if (wo.z == 0) return std::nullopt;
  std::optional<V3f> wi = principled->draw(above(wo), u);
  if (!wi) return std::nullopt;
  const float pdf = principled->density(above(wo), *wi);
  if (!(pdf > 0)) return std::nullopt;
  wi->z = std::copysign(wi->z, wo.z);
  return BsdfSample{.wi = *wi, .weight = eval(wo, *wi, mode) * (std::abs(wi->z) / pdf), .pdf = pdf};
}

SampledSpectrum PrincipledBsdf::pdf(const V3f& wo, const V3f& wi) const {
  return SampledSpectrum(wo.z * wi.z > 0 ? principled->density(above(wo), above(wi)) : 0.0F);
}

}  // namespace abbe

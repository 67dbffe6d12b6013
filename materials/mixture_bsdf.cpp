#include "materials/bsdf/mixture.h"

#include <algorithm>
#include <cmath>

#include "materials/bsdf/polarisation.h"
#include "materials/interface/quotient.h"
#include "materials/material.h"

namespace abbe {
namespace {

SampledSpectrum total_weight(const MixtureMaterial& material, const SampledSpectrum& wavelengths_nm) {
  SampledSpectrum sum;
  for (const MixtureMaterial::Component& component : material.components)
    sum += component.weight(wavelengths_nm);
  return sum;
}

/// A component, its weight at each wavelength, and a random number in [0, 1) left for sampling the component.
struct Choice {
  const MixtureMaterial::Component* component = nullptr;
  SampledSpectrum weight;
  float rest = 0;
};
Choice choose(const MixtureMaterial& material, const SampledSpectrum& wavelengths_nm, float u, float total,
              int hero) {
  Choice choice;
  float left = u * total;
  for (const MixtureMaterial::Component& component : material.components) {
    const SampledSpectrum weight = component.weight(wavelengths_nm);
    if (!(weight[hero] > 0)) continue;
    choice = {&component, weight, std::clamp(left / weight[hero], 0.0F, 0x1.fffffep-1F)};
    if (left < weight[hero]) break;
    left -= weight[hero];
  }
  return choice;
}

}  // namespace

std::optional<BsdfSample> MixtureBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                              TransportMode mode) const {
  const SampledSpectrum total = total_weight(*material_, wavelengths_nm_);
  if (!(total[hero] > 0)) return std::nullopt;
  const Choice chosen = choose(*material_, wavelengths_nm_, u.lobe, total[hero], hero);
  auto s =
      abbe::sample(make_bsdf(*chosen.component->material, at()), wo, {chosen.rest, u.direction}, hero, mode);
  if (!s) return std::nullopt;
  if (s->delta) {
    const SampledSpectrum probability = quotient(chosen.weight, total);
    s->pdf *= probability[hero];
    s->lane_pdf *= probability * (1 / probability[hero]);
    s->weight *= chosen.weight * (1 / probability[hero]);
    return s;
  }
  const SampledSpectrum density = pdf(wo, s->wi);
  if (!(density[hero] > 0)) return std::nullopt;
  s->pdf = density[hero];
  s->lane_pdf = density * (1 / density[hero]);
  s->weight = eval(wo, s->wi, mode) * (std::abs(s->wi.z) / density[hero]);
  return s;
}

SampledSpectrum MixtureBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const {
  SampledSpectrum f;
  for (const MixtureMaterial::Component& component : material_->components)
    f += component.weight(wavelengths_nm_) * abbe::eval(make_bsdf(*component.material, at()), wo, wi, mode);
  return f;
}

SampledSpectrum MixtureBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  SampledSpectrum weighted;
  for (const MixtureMaterial::Component& component : material_->components)
    weighted += component.weight(wavelengths_nm_) * abbe::pdf(make_bsdf(*component.material, at()), wo, wi);
  return quotient(weighted, total_weight(*material_, wavelengths_nm_));
}

SampledSpectrum MixtureBsdf::delta_probability(const Imath::V3f& wo) const {
  SampledSpectrum weighted;
  for (const MixtureMaterial::Component& component : material_->components)
    weighted +=
        component.weight(wavelengths_nm_) * abbe::delta_probability(make_bsdf(*component.material, at()), wo);
  return quotient(weighted, total_weight(*material_, wavelengths_nm_));
}

SampledSpectrum MixtureBsdf::delta_power(const Imath::V3f& wo, bool through) const {
  SampledSpectrum power;
  for (const MixtureMaterial::Component& component : material_->components)
    power += component.weight(wavelengths_nm_) *
             abbe::delta_power(make_bsdf(*component.material, at()), wo, through);
  return power;
}

// A transmitted direction has no refraction scale, because light does not enter any component.
std::optional<MuellerMatrix> MixtureBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& wi,
                                                  bool delta) const {
  MuellerMean<SampledSpectrum> mean;
  std::optional<Imath::V3f> axis;
  for (const MixtureMaterial::Component& component : material_->components) {
    const Bsdf part = make_bsdf(*component.material, at());
    const SampledSpectrum power =
        component.weight(wavelengths_nm_) * (delta ? abbe::delta_power(part, wo, wo.z * wi.z < 0)
                                                   : abbe::eval(part, wo, wi, TransportMode::power));
    if (power.is_zero()) continue;
    const auto own = abbe::mueller(part, wo, wi, delta);
    if (own)
      mean.add(power, {own->d, own->p, own->c, own->s});
    else
      mean.add_unpolarised(power);
    if (own && !axis) axis = own->axis;
  }
  if (!axis) return std::nullopt;
  const MuellerElements<SampledSpectrum> elements = mean.mean();
  return MuellerMatrix{*axis, elements.d, elements.p, elements.c, elements.s};
}

}  // namespace abbe

#include "materials/bsdf/mixture.h"

#include <algorithm>
#include <cmath>

#include "materials/bsdf/polarisation.h"
#include "materials/material.h"

namespace abbe {
namespace {

SampledSpectrum quotient(const SampledSpectrum& a, const SampledSpectrum& b) {
  return SampledSpectrum::map(a, b, [](float x, float y) { return y > 0 ? x / y : 0.0F; });
}

SampledSpectrum total_weight(const MixtureMaterial& material, const SampledSpectrum& wavelengths_nm) {
  SampledSpectrum sum;
  for (const MixtureMaterial::Component& component : material.components)
    sum += component.weight(wavelengths_nm);
  return sum;
}

/// A component, what it weighs in each lane, and the number in [0, 1) left for its own choice.
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

SampledSpectrum delta_power(const Bsdf& part, const Imath::V3f& wo, bool through) {
  return visit_model(
      [&](const auto& model) {
        if constexpr (requires { model.delta_power(wo, through); })
          return model.delta_power(wo, through);
        else
          return SampledSpectrum();
      },
      part);
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
    const SampledSpectrum share = quotient(chosen.weight, total);
    s->pdf *= share[hero];
    s->lane_pdf *= share * (1 / share[hero]);
    s->weight *= chosen.weight * (1 / share[hero]);
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

// Light enters no part, so that none scales what passes.
std::optional<MuellerMatrix> MixtureBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& wi,
                                                  bool delta) const {
  SampledSpectrum total;
  std::optional<MuellerMatrix> sum;
  for (const MixtureMaterial::Component& component : material_->components) {
    const Bsdf part = make_bsdf(*component.material, at());
    const SampledSpectrum power =
        component.weight(wavelengths_nm_) *
        (delta ? delta_power(part, wo, wo.z * wi.z < 0) : abbe::eval(part, wo, wi, TransportMode::power));
    total += power;
    const auto own = power.is_zero() ? std::nullopt : abbe::mueller(part, wo, wi, delta);
    if (!own) continue;
    if (!sum) sum = {own->axis, {}, {}, {}, {}};
    sum->d += power * own->d;
    sum->p += power * own->p;
    sum->c += power * own->c;
    sum->s += power * own->s;
  }
  if (sum)
    for (SampledSpectrum* element : {&sum->d, &sum->p, &sum->c, &sum->s})
      *element = quotient(*element, total);
  return sum;
}

}  // namespace abbe

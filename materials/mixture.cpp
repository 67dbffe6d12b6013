#include "materials/mixture.h"

#include <algorithm>
#include <cmath>

#include "materials/bsdf.h"
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

const Material& material_of(const MixtureMaterial::Component& component) {
  return *component.material;
}

}  // namespace

Lobes MixtureMaterial::lobes() const {
  Lobes all;
  for (const Component& component : components) {
    const Lobes own = abbe::lobes(*component.material);
    all = {all.delta || own.delta, all.spread || own.spread};
  }
  return all;
}

bool MixtureMaterial::needs_coordinates() const {
  return std::ranges::any_of(components, abbe::needs_coordinates, material_of);
}

bool MixtureMaterial::depends_on_outside() const {
  return std::ranges::any_of(components, abbe::depends_on_outside, material_of);
}

bool MixtureMaterial::polarises() const {
  return std::ranges::any_of(components, abbe::polarises, material_of);
}

bool MixtureMaterial::preserves_polarisation() const {
  return std::ranges::any_of(components, abbe::preserves_polarisation, material_of);
}

bool MixtureMaterial::opaque() const {
  return std::ranges::all_of(components, abbe::opaque, material_of);
}

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

// The sum of `quantity` of the components' models, weighted by the components.
template <typename Quantity>
SampledSpectrum MixtureBsdf::weighted(Quantity quantity) const {
  SampledSpectrum sum;
  for (const MixtureMaterial::Component& component : material_->components)
    sum += component.weight(wavelengths_nm_) * quantity(make_bsdf(*component.material, at()));
  return sum;
}

SampledSpectrum MixtureBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const {
  return weighted([&](const Bsdf& part) { return abbe::eval(part, wo, wi, mode); });
}

SampledSpectrum MixtureBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  return quotient(weighted([&](const Bsdf& part) { return abbe::pdf(part, wo, wi); }),
                  total_weight(*material_, wavelengths_nm_));
}

SampledSpectrum MixtureBsdf::delta_probability(const Imath::V3f& wo) const {
  return quotient(weighted([&](const Bsdf& part) { return abbe::delta_probability(part, wo); }),
                  total_weight(*material_, wavelengths_nm_));
}

SampledSpectrum MixtureBsdf::delta_power(const Imath::V3f& wo, bool through) const {
  return weighted([&](const Bsdf& part) { return abbe::delta_power(part, wo, through); });
}

// A transmitted direction has no refraction scale, because light does not enter any component.
std::optional<MuellerMatrix> MixtureBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& wi, bool delta,
                                                  std::optional<int> /*lane*/) const {
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

std::optional<FresnelPower<double>> MixtureMaterial::smooth_power(const SmoothLookup& at) const {
  std::optional<FresnelPower<double>> sum;
  for (const Component& component : components) {
    const auto part = abbe::smooth_power(*component.material, at);
    if (!part) continue;
    const double weight = component.weight(at.wavelength_nm);
    const FresnelPower<double> so_far = sum.value_or(FresnelPower<double>{0, 0, 0, 0, 0});
    sum = {{so_far.Rs + weight * part->Rs, so_far.Rp + weight * part->Rp, so_far.Ts + weight * part->Ts,
            so_far.Tp + weight * part->Tp, at.cos_i}};
  }
  return sum;
}

// Mean over the components, weighted by the power that each reflects or transmits.
SmoothMueller MixtureMaterial::smooth_mueller(const SmoothLookup& at) const {
  MuellerMean<double> reflected;
  MuellerMean<double> through;
  for (const Component& component : components) {
    const auto power = abbe::smooth_power(*component.material, at);
    if (!power) continue;
    const double weight = component.weight(at.wavelength_nm);
    const InterfaceMueller<double> part = abbe::smooth_mueller(*component.material, at)->matrices;
    reflected.add(weight * power->R(), part.reflected);
    through.add(weight * power->transmitted(), part.through);
  }
  return {{reflected.mean(), through.mean()}};
}

}  // namespace abbe

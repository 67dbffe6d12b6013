#include <algorithm>
#include <cmath>

#include "materials/bsdf/facet_event.h"
#include "materials/bsdf/mirror.h"
#include "materials/bsdf/rough.h"

namespace abbe {
namespace {

using Quadratic = std::array<SampledSpectrum, RoughInterface::kIndices>;

// Of each lane, the weights of the three indices that a surface is tabulated at.
Quadratic weights(const RoughInterface& surface, const SampledSpectrum& n) {
  const float range = surface.high_n - surface.low_n;
  const SampledSpectrum one(1);
  const SampledSpectrum w = SampledSpectrum::map(n, [&](float lane_n) {
    return range > 0 ? std::clamp((lane_n - surface.low_n) / range, 0.0F, 1.0F) : 0.0F;
  });
  return {(one - w) * (one - 2 * w), 4 * w * (one - w), w * (2 * w - one)};
}

// Lane by lane, the value of the tables of one side by `read`.
template <typename F>
SampledSpectrum at_lanes(const RoughInterface& surface, bool inside, const Quadratic& weights, F read) {
  const auto& tables = surface.lost[inside ? 1 : 0];
  SampledSpectrum sum;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * read(tables[k]);
  return SampledSpectrum::map(sum, [](float x) { return std::max(x, 0.0F); });
}
SampledSpectrum lost_energy(const RoughInterface& surface, bool inside, const Quadratic& weights,
                            const EnergyCompensation::Place& place) {
  return at_lanes(surface, inside, weights, [&](const EnergyCompensation& table) { return table.at(place); });
}

// Power sent from o into i, lane by lane, times the cosine of i [1/sr], and the density of i were each lane
// the hero; of the power what a single facet has sent there.
struct Scattered {
  SampledSpectrum power, pdf, single;
};

// That of facets alone. Masking goes by the height in reflection, where o and i see the same side.
Scattered by_facets(const Microfacets<float>& facets, const SampledSpectrum& eta, const Imath::V3f& o,
                    const Imath::V3f& i) {
  const float lambda_o = facets.lambda(o);
  const float lambda_i = facets.lambda(i);
  const float seen = 1 / ((1 + lambda_o) * o.z);
  if (i.z > 0) {
    const FacetMirror mirror = facet_mirror(facets, seen, o, i);
    const SampledSpectrum there = mirror.density * SampledSpectrum::map(eta, [&](float lane_eta) {
                                    return fresnel_dielectric(mirror.cos, lane_eta).R();
                                  });
    const SampledSpectrum power = there * ((1 + lambda_o) / (1 + lambda_o + lambda_i));
    return {power, there, power};
  }
  const SampledSpectrum there = SampledSpectrum::map(
      eta, [&](float lane_eta) { return facet_refraction(facets, seen, o, i, lane_eta); });
  const SampledSpectrum power = there * (1 / (1 + lambda_i));
  return {power, there, power};
}

// Including what is scattered more than once: with A_s the integral of what side s loses over projected solid
// angle, (1 - E(o)) (1 - E(i)) n_i^2 / (A_outside + n^2 A_inside).
Scattered scattered(const RoughDielectricBsdf& bsdf, bool inside, const Imath::V3f& o, const Imath::V3f& i) {
  const RoughInterface& surface = *bsdf.surface;
  const SampledSpectrum& n = bsdf.n;
  const Scattered once = by_facets(surface.facets, inside ? SampledSpectrum(1) / n : n, o, i);
  if (!bsdf.compensated) return once;
  const Quadratic w = weights(surface, n);
  const bool into_inside = inside == (i.z > 0);
  const EnergyCompensation::Place place_i = EnergyCompensation::place(surface.facets, i);
  const SampledSpectrum lost = lost_energy(surface, inside, w, EnergyCompensation::place(surface.facets, o));
  const auto total = [](const EnergyCompensation& table) { return table.total(); };
  const SampledSpectrum leaves =
      at_lanes(surface, false, w, total) + n * n * at_lanes(surface, true, w, total);
  SampledSpectrum share = lost_energy(surface, into_inside, w, place_i) * std::abs(i.z) / leaves;
  if (into_inside) share *= n * n;

  const float density = (into_inside ? surface.inside_share : 1 - surface.inside_share) *
                        surface.lost[into_inside ? 1 : 0][1].pdf(place_i, std::abs(i.z));
  return {once.power + lost * share, (SampledSpectrum(1) - lost) * once.pdf + lost * density, once.power};
}

// What refraction does to the quantity carried into `wi`, lane by lane.
SampledSpectrum scale(const SampledSpectrum& n, const Imath::V3f& wo, const Imath::V3f& wi,
                      TransportMode mode) {
  if (wo.z * wi.z > 0) return SampledSpectrum(1);
  return SampledSpectrum::map(
      n, [&](float lane_n) { return refraction_scale(wo.z < 0 ? 1 / lane_n : lane_n, mode); });
}

// By a facet, drawn by `direction`; reflected if `choice` is below its reflectance. Nothing where it would
// have to be scattered again to leave that way.
std::optional<Imath::V3f> off_facet(const Microfacets<float>& facets, const Imath::V3f& o, float eta,
                                    const Imath::V2f& direction, float choice) {
  const Imath::V3f h = facets.sample_visible(o, direction);
  const float cos = std::min(o.dot(h), 1.0F);
  const FresnelPower<float> f = fresnel_dielectric(cos, eta);
  const bool reflected = choice < f.R();
  const Imath::V3f i = (reflected ? h * (2 * cos) - o : h * (cos / eta - f.cos_t) - o / eta).normalized();
  return i.z != 0 && reflected == (i.z > 0) ? std::optional(i) : std::nullopt;
}

// Scattered more than once: the side first, by `choice`.
Imath::V3f off_surface(const RoughInterface& surface, bool inside, const Imath::V2f& direction,
                       float choice) {
  const bool into_inside = choice < surface.inside_share;
  const Imath::V3f i = surface.lost[into_inside ? 1 : 0][1].sample(direction);
  return {i.x, i.y, into_inside == inside ? i.z : -i.z};
}

}  // namespace

std::optional<BsdfSample> RoughDielectricBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                      TransportMode mode) const {
  if (wo.z == 0) return std::nullopt;
  const bool inside = wo.z < 0;
  const Imath::V3f o = from_side_of(wo, wo);
  const float lost = compensated ? lost_energy(*surface, inside, weights(*surface, n),
                                               EnergyCompensation::place(surface->facets, o))[hero]
                                 : 0.0F;
  const std::optional<Imath::V3f> i = u.lobe < lost
                                          ? off_surface(*surface, inside, u.direction, u.lobe / lost)
                                          : off_facet(surface->facets, o, inside ? 1 / n[hero] : n[hero],
                                                      u.direction, (u.lobe - lost) / (1 - lost));
  if (!i) return std::nullopt;
  const Scattered all = scattered(*this, inside, o, *i);
  const float pdf = all.pdf[hero];
  if (!(pdf > 0)) return std::nullopt;
  const Imath::V3f wi = from_side_of(wo, *i);
  return BsdfSample{.wi = wi,
                    .weight = all.power * scale(n, wo, wi, mode) * (1 / pdf),
                    .lane_pdf = all.pdf * (1 / pdf),
                    .pdf = pdf,
                    .transmitted = i->z < 0};
}

SampledSpectrum RoughDielectricBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi,
                                          TransportMode mode) const {
  if (wo.z == 0 || wi.z == 0) return {};
  const Scattered all = scattered(*this, wo.z < 0, from_side_of(wo, wo), from_side_of(wo, wi));
  return all.power * scale(n, wo, wi, mode) * (1 / std::abs(wi.z));
}

SampledSpectrum RoughDielectricBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  if (wo.z == 0 || wi.z == 0) return {};
  return scattered(*this, wo.z < 0, from_side_of(wo, wo), from_side_of(wo, wi)).pdf;
}

SampledSpectrum RoughDielectricBsdf::single_share(const Imath::V3f& wo, const Imath::V3f& wi) const {
  if (wo.z == 0 || wi.z == 0) return {};
  const Scattered all = scattered(*this, wo.z < 0, from_side_of(wo, wo), from_side_of(wo, wi));
  return share_of(all.single, all.power);
}

}  // namespace abbe

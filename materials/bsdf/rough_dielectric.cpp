#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "materials/bsdf/facet_event.h"
#include "materials/bsdf/mirror.h"
#include "materials/bsdf/rough.h"

namespace abbe {
namespace {

using Weights = std::array<SampledSpectrum, RoughInterface::kMaxIndices>;

// Weights of the tabulated indices at each wavelength.
Weights weights(const RoughInterface& surface, const SampledSpectrum& n) {
  const std::vector<float>& at = surface.coordinates;
  Weights weights;
  if (at.size() == 1) weights[0] = SampledSpectrum(1);
  const SampledSpectrum x = SampledSpectrum::map(
      n, [&](float lane_n) { return std::clamp(RoughInterface::coordinate(lane_n), at.front(), at.back()); });
  const SampledSpectrum one(1);
  for (std::size_t k = 0; k + 2 < at.size(); k += 2) {
    const float end = k + 3 < at.size() ? at[k + 2] : std::numeric_limits<float>::infinity();
    const SampledSpectrum within =
        SampledSpectrum::map(x, [&](float lane_x) { return lane_x >= at[k] && lane_x < end ? 1.0F : 0.0F; });
    const SampledSpectrum w =
        SampledSpectrum::map(x, [&](float lane_x) { return (lane_x - at[k]) / (at[k + 2] - at[k]); });
    weights[k] += within * (one - w) * (one - 2 * w);
    weights[k + 1] += within * 4 * w * (one - w);
    weights[k + 2] += within * w * (2 * w - one);
  }
  return weights;
}

// Interpolates `read` of the tables of one side to the indices of the wavelengths.
template <typename F>
SampledSpectrum at_lanes(const RoughInterface& surface, bool inside, const Weights& weights, F read) {
  const auto& tables = surface.lost[inside ? 1 : 0];
  SampledSpectrum sum;
  for (std::size_t k = 0; k < tables.size(); ++k) sum += weights[k] * read(tables[k]);
  return SampledSpectrum::map(sum, [](float x) { return std::max(x, 0.0F); });
}
SampledSpectrum lost_energy(const RoughInterface& surface, bool inside, const Weights& weights,
                            const EnergyCompensation::TableCoordinates& coordinates) {
  return at_lanes(surface, inside, weights,
                  [&](const EnergyCompensation& table) { return table.at(coordinates); });
}

// BSDF from o to i times the cosine of i [1/sr] at each wavelength: `single` scattering, and `power` in
// total. `pdf` is the pdf of i [1/sr] if that wavelength is the hero.
struct Scattered {
  SampledSpectrum single, power, pdf;
};

// BSDF of single scattering times the cosine of i.
SampledSpectrum by_facets(const Microfacets<float>& facets, const SampledSpectrum& eta, const Imath::V3f& o,
                          const Imath::V3f& i) {
  const float lambda_o = facets.lambda(o);
  const float passed = unmasked(lambda_o, facets.lambda(i), i.z > 0);
  const float visible = 1 / ((1 + lambda_o) * o.z);
  if (i.z > 0) {
    const FacetMirror mirror = facet_mirror(facets, visible, o, i);
    return mirror.density * passed * SampledSpectrum::map(eta, [&](float lane_eta) {
             return fresnel_dielectric(mirror.cos, lane_eta).R();
           });
  }
  return passed * SampledSpectrum::map(
                      eta, [&](float lane_eta) { return facet_refraction(facets, visible, o, i, lane_eta); });
}

// Single and multiple scattering. Let A_s be the integral of 1 - E over the projected solid angle of side s.
// Multiple scattering is (1 - E(o)) (1 - E(i)) n_i^2 / (A_outside + n^2 A_inside).
//
// `sample` draws a facet. If other facets mask its light, `sample` draws a direction of multiple scattering.
// The pdf of the first case equals the power of single scattering. The probability of the second is 1 - E(o),
// for which the pdf uses the value of the table.
Scattered scattered(const RoughDielectricBsdf& bsdf, bool inside, const Imath::V3f& o, const Imath::V3f& i) {
  const RoughInterface& surface = *bsdf.surface;
  const SampledSpectrum& n = bsdf.n;
  const SampledSpectrum once = by_facets(surface.facets, inside ? SampledSpectrum(1) / n : n, o, i);
  const Weights w = weights(surface, n);
  const bool into_inside = inside == (i.z > 0);
  const EnergyCompensation::TableCoordinates coordinates_i =
      EnergyCompensation::table_coordinates(surface.facets, i);
  const SampledSpectrum lost =
      lost_energy(surface, inside, w, EnergyCompensation::table_coordinates(surface.facets, o));
  const auto total = [](const EnergyCompensation& table) { return table.total(); };
  const SampledSpectrum total_of_both =
      at_lanes(surface, false, w, total) + n * n * at_lanes(surface, true, w, total);
  SampledSpectrum fraction =
      lost_energy(surface, into_inside, w, coordinates_i) * std::abs(i.z) / total_of_both;
  if (into_inside) fraction *= n * n;

  const float density =
      (into_inside ? surface.inside_probability : 1 - surface.inside_probability) *
      surface.lost[into_inside ? 1 : 0][surface.sampling_index()].pdf(coordinates_i, std::abs(i.z));
  return {once, once + lost * fraction, once + lost * density};
}

// Factor by which refraction into `wi` scales the quantity of the path, at each wavelength.
SampledSpectrum scale(const SampledSpectrum& n, const Imath::V3f& wo, const Imath::V3f& wi,
                      TransportMode mode) {
  if (wo.z * wi.z > 0) return SampledSpectrum(1);
  return SampledSpectrum::map(
      n, [&](float lane_n) { return refraction_scale(wo.z < 0 ? 1 / lane_n : lane_n, mode); });
}

// Direction of light from o after a facet sampled by `u`. Empty if another facet masks it. This is certain if
// the direction is on the wrong side of the surface, else it has the probability of masking.
std::optional<Imath::V3f> off_facet(const Microfacets<float>& facets, const Imath::V3f& o, float eta,
                                    const BsdfRandom& u) {
  const Imath::V3f h = facets.sample_visible(o, u.direction);
  const float cos = std::min(o.dot(h), 1.0F);
  const FresnelPower<float> f = fresnel_dielectric(cos, eta);
  const float R = f.R();
  const bool reflected = u.lobe < R;
  const Imath::V3f i = (reflected ? h * (2 * cos) - o : h * (cos / eta - f.cos_t) - o / eta).normalized();
  if (i.z == 0 || reflected != (i.z > 0)) return std::nullopt;
  const float rest = reflected ? u.lobe / R : (u.lobe - R) / (1 - R);
  return rest < unmasked(facets.lambda(o), facets.lambda(i), reflected) ? std::optional(i) : std::nullopt;
}

// Samples a direction of multiple scattering. u.lobe selects the side.
Imath::V3f off_surface(const RoughInterface& surface, bool inside, const BsdfRandom& u) {
  const bool into_inside = u.lobe < surface.inside_probability;
  const Imath::V3f i = surface.lost[into_inside ? 1 : 0][surface.sampling_index()].sample(u.direction);
  return {i.x, i.y, into_inside == inside ? i.z : -i.z};
}

}  // namespace

std::optional<BsdfSample> RoughDielectricBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                      TransportMode mode) const {
  if (wo.z == 0) return std::nullopt;
  const bool inside = wo.z < 0;
  const Imath::V3f o = from_side_of(wo, wo);
  const std::optional<Imath::V3f> once = off_facet(surface->facets, o, inside ? 1 / n[hero] : n[hero], u);
  const Imath::V3f i = once ? *once : off_surface(*surface, inside, redrawn(u));
  const Scattered all = scattered(*this, inside, o, i);
  const float pdf = all.pdf[hero];
  if (!(pdf > 0)) return std::nullopt;
  const Imath::V3f wi = from_side_of(wo, i);
  return BsdfSample{.wi = wi,
                    .weight = all.power * scale(n, wo, wi, mode) * (1 / pdf),
                    .lane_pdf = all.pdf * (1 / pdf),
                    .pdf = pdf,
                    .transmitted = i.z < 0};
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

SampledSpectrum RoughDielectricBsdf::single_fraction(const Imath::V3f& wo, const Imath::V3f& wi) const {
  if (wo.z == 0 || wi.z == 0) return {};
  const Scattered all = scattered(*this, wo.z < 0, from_side_of(wo, wo), from_side_of(wo, wi));
  return fraction_of(all.single, all.power);
}

}  // namespace abbe

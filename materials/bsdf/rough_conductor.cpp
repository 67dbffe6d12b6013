#include <cmath>
#include <numbers>

#include "materials/bsdf/facet_event.h"
#include "materials/bsdf/rough.h"
#include "materials/index/relative_index.h"

namespace abbe {
namespace {

// Reflection from o to i by perfectly reflecting facets, times the cosine of i [1/sr]: by a single facet and
// by multiple scattering. `RoughDielectricBsdf` describes how directions are sampled.
struct Reflection {
  float single = 0;
  float multiple = 0;
  float cos = 0;  // of incidence on the facets of `single`
  float pdf = 0;
};

Reflection reflection(const RoughMetal& surface, const Imath::V3f& o, const Imath::V3f& i) {
  const Microfacets<float>& facets = surface.facets;
  const float lambda_o = facets.lambda(o);
  const FacetMirror mirror = facet_mirror(facets, 1 / ((1 + lambda_o) * o.z), o, i);
  const float single = mirror.density * unmasked(lambda_o, facets.lambda(i), true);
  const EnergyCompensation::TableCoordinates coordinates = EnergyCompensation::table_coordinates(facets, i);
  const float lost = surface.lost.at(EnergyCompensation::table_coordinates(facets, o));
  return {single, lost * surface.lost.at(coordinates) * i.z / surface.lost.total(), mirror.cos,
          single + lost * surface.lost.pdf(coordinates, i.z)};
}

// f cos at each wavelength.
struct Coloured {
  SampledSpectrum single, multiple;

  [[nodiscard]] SampledSpectrum all() const { return single + multiple; }
};
Coloured coloured(const RoughConductorBsdf& bsdf, const Reflection& r) {
  const RelativeIndex index = relative_index(*bsdf.index, bsdf.outside, bsdf.wavelengths_nm);
  const SampledSpectrum once = SampledSpectrum::map(
      index.n, index.k, [&](float n, float k) { return fresnel_conductor(r.cos, n, k).R(); });
  // F^2 E + F^2 (1 - E) F E + ...: two or more reflections, after each of which a mean energy E leaves
  // [Kulla2017].
  const float energy = 1 - bsdf.surface->lost.total() * std::numbers::inv_pi_v<float>;
  const SampledSpectrum often = SampledSpectrum::map(bsdf.mean_reflectance, [energy](float mean) {
    return mean * mean * energy / (1 - mean * (1 - energy));
  });
  return {once * r.single, often * r.multiple};
}

}  // namespace

std::optional<BsdfSample> RoughConductorBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int /*hero*/,
                                                     TransportMode /*mode*/) const {
  if (wo.z == 0) return std::nullopt;
  const Imath::V3f o = from_side_of(wo, wo);
  const Microfacets<float>& facets = surface->facets;
  const Imath::V3f h = facets.sample_visible(o, u.direction);
  Imath::V3f i = (h * (2 * o.dot(h)) - o).normalized();
  if (!(i.z > 0 && u.lobe < unmasked(facets.lambda(o), facets.lambda(i), true)))
    i = surface->lost.sample(redrawn(u).direction);
  const Reflection r = reflection(*surface, o, i);
  if (!(r.pdf > 0)) return std::nullopt;
  return BsdfSample{
      .wi = from_side_of(wo, i), .weight = coloured(*this, r).all() * (1 / r.pdf), .pdf = r.pdf};
}

SampledSpectrum RoughConductorBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi,
                                         TransportMode /*mode*/) const {
  if (!(wo.z * wi.z > 0)) return {};
  const Reflection r = reflection(*surface, from_side_of(wo, wo), from_side_of(wo, wi));
  return coloured(*this, r).all() * (1 / std::abs(wi.z));
}

SampledSpectrum RoughConductorBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  if (!(wo.z * wi.z > 0)) return {};
  return SampledSpectrum(reflection(*surface, from_side_of(wo, wo), from_side_of(wo, wi)).pdf);
}

SampledSpectrum RoughConductorBsdf::single_fraction(const Imath::V3f& wo, const Imath::V3f& wi) const {
  if (!(wo.z * wi.z > 0)) return {};
  const Coloured f = coloured(*this, reflection(*surface, from_side_of(wo, wo), from_side_of(wo, wi)));
  return fraction_of(f.single, f.all());
}

}  // namespace abbe

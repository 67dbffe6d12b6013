#include "materials/bsdf/rough.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "sampling/sampler.h"

namespace abbe {
namespace {

// A local direction in the frame in which `wo` is above the surface.
Imath::V3f from_side_of(const Imath::V3f& wo, const Imath::V3f& w) {
  return {w.x, w.y, wo.z < 0 ? -w.z : w.z};
}

// part/all at each wavelength, limited to 1; 0 if `all` is not positive.
SampledSpectrum fraction_of(const SampledSpectrum& part, const SampledSpectrum& all) {
  return SampledSpectrum::map(part, all,
                              [](float x, float y) { return y > 0 ? std::min(x / y, 1.0F) : 0.0F; });
}

// Random numbers for a second sample: hashes of the first ones, practically independent of them.
BsdfRandom redrawn(const BsdfRandom& u) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  const std::uint32_t key = combine(combine(bits(u.lobe), bits(u.direction.x)), bits(u.direction.y));
  const auto number = [key](std::uint32_t i) { return static_cast<float>(combine(key, i) >> 8U) * 0x1p-24F; };
  return {number(0), {number(1), number(2)}};
}

// Matrix of light that facets scatter from wo to wi, with `elements(lane)` for a single facet. Multiply
// scattered light is assumed unpolarised.
template <typename Rough, typename F>
MuellerMatrix facet_mueller(const Rough& surface, const Imath::V3f& wo, const Imath::V3f& wi, F elements) {
  MuellerMatrix m = mueller_of_lanes(across(wo, wi), elements);
  const SampledSpectrum fraction = surface.single_fraction(wo, wi);
  for (SampledSpectrum* element : {&m.d, &m.p, &m.c, &m.s}) *element *= fraction;
  return m;
}

// Table of the energy that perfectly reflecting facets lose.
EnergyCompensation lost_by_mirror(const Microfacets<float>& facets) {
  return EnergyCompensation::tabulate(facets, 1, [&](const Imath::V3f& w, std::span<double> energies) {
    energies[0] = mirror_energy(facets, w);
  })[0];
}

// The relative index n at a coordinate x: the inverse of `RoughInterface::coordinate`.
float index_at(float coordinate) {
  return 1 + coordinate * std::abs(coordinate);
}

// Relative indices at the coordinates for light from outside, followed by those for light from inside.
std::vector<float> both_sides(std::span<const float> coordinates) {
  std::vector<float> etas;
  for (const float x : coordinates) etas.push_back(index_at(x));
  for (const float x : coordinates) etas.push_back(1 / index_at(x));
  return etas;
}

// Largest error of quadratic interpolation of the energies between two coordinates, tested at one and three
// quarters. The cotangents of the tested directions are multiples of the width of slopes.
double interpolation_error(const Microfacets<float>& facets, float low, float high) {
  const float step = (high - low) / 4;
  const std::vector<float> etas =
      both_sides(std::array{low, low + step, low + 2 * step, low + 3 * step, high});
  std::vector<double> energies(etas.size());
  double largest = 0;
  for (const Imath::V2f& along : {Imath::V2f(1, 0), Imath::V2f(0, 1)})
    for (const float cotangent : {0.25F, 0.5F, 1.0F, 2.0F, 4.0F}) {
      const float width = facets.projected_alpha({along.x, along.y, 0});
      dielectric_energies(facets, Imath::V3f(along.x, along.y, cotangent * width).normalized(), etas,
                          energies);
      for (const double* e : {&energies[0], &energies[5]})
        largest = std::max({largest, std::abs(0.375 * e[0] + 0.75 * e[2] - 0.125 * e[4] - e[1]),
                            std::abs(0.375 * e[4] + 0.75 * e[2] - 0.125 * e[0] - e[3])});
    }
  return largest;
}

// Adds the coordinates above `low` up to `high`. The interval is halved up to `halvings` times while the
// interpolation error exceeds 2e-3 of the light, the precision of a table in direction.
void add_coordinates(const Microfacets<float>& facets, float low, float high, int halvings,
                     std::vector<float>& coordinates) {
  constexpr double kTolerance = 2e-3;
  const float center = (low + high) / 2;
  if (halvings == 0 || interpolation_error(facets, low, high) < kTolerance) {
    coordinates.insert(coordinates.end(), {center, high});
    return;
  }
  add_coordinates(facets, low, center, halvings - 1, coordinates);
  add_coordinates(facets, center, high, halvings - 1, coordinates);
}

std::vector<float> tabulated_coordinates(const Microfacets<float>& facets, float low_n, float high_n) {
  const float low = RoughInterface::coordinate(low_n);
  const float high = RoughInterface::coordinate(high_n);
  std::vector<float> coordinates{low};
  if (low < 0 && high > 0) {
    add_coordinates(facets, low, 0, 2, coordinates);
    add_coordinates(facets, 0, high, 2, coordinates);
  } else if (low < high) {
    add_coordinates(facets, low, high, 3, coordinates);
  }
  return coordinates;
}

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

// The relative index n, moved away from 1 if it differs by less than the tables allow.
float with_min_contrast(float n) {
  constexpr float kMinContrast = 1e-3F;
  return std::abs(n - 1) < kMinContrast ? 1 + std::copysign(kMinContrast, n - 1) : n;
}

// Smallest and largest relative index of a material, relative to a medium or, for nullptr, to air.
struct IndexRange {
  float low, high;
};
IndexRange range_of(const RefractiveIndex& index, const RefractiveIndex* medium) {
  const auto relative = [&](double nm) {
    return static_cast<float>(index.n(nm) / (medium != nullptr ? medium->n(nm) : 1));
  };
  IndexRange range{relative(kMinWavelengthNm), relative(kMinWavelengthNm)};
  const bool dispersive = index.dispersive() || (medium != nullptr && medium->dispersive());
  for (int nm = kMinWavelengthNm; dispersive && nm <= kMaxWavelengthNm; ++nm) {
    const float n = relative(nm);
    range = {std::min(range.low, n), std::max(range.high, n)};
  }
  return {with_min_contrast(range.low), with_min_contrast(range.high)};
}

std::shared_ptr<const RoughInterface> make_interface(const Microfacets<float>& facets,
                                                     const IndexRange& range) {
  return std::make_shared<RoughInterface>(facets, range.low, range.high);
}

}  // namespace

RoughMetal::RoughMetal(const Microfacets<float>& of) : facets(of), lost(lost_by_mirror(of)) {}

RoughInterface::RoughInterface(const Microfacets<float>& of, float low, float high)
    : facets(of), low_n(low), high_n(high), coordinates(tabulated_coordinates(of, low, high)) {
  const std::vector<float> etas = both_sides(coordinates);
  const std::vector<EnergyCompensation> tables =
      EnergyCompensation::tabulate(facets, etas.size(), [&](const Imath::V3f& w, std::span<double> energies) {
        dielectric_energies(facets, w, etas, energies);
      });
  const auto inner = tables.begin() + static_cast<std::ptrdiff_t>(coordinates.size());
  lost[0].assign(tables.begin(), inner);
  lost[1].assign(inner, tables.end());
  const float n = index_at(coordinates[sampling_index()]);
  const float inside = n * n * lost[1][sampling_index()].total();
  inside_probability = inside / (lost[0][sampling_index()].total() + inside);
}

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

std::optional<MuellerMatrix> RoughConductorBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& wi,
                                                         bool /*delta*/, std::optional<int> /*lane*/) const {
  const RelativeIndex at = relative_index(*index, outside, wavelengths_nm);
  const float cos = mirror_cosine(wo, wi);
  return facet_mueller(*this, wo, wi,
                       [&](int lane) { return reflection_mueller(cos, at.n[lane], at.k[lane]); });
}

std::optional<MuellerMatrix> RoughDielectricBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& wi,
                                                          bool /*delta*/, std::optional<int> /*lane*/) const {
  const bool through = wo.z * wi.z < 0;
  return facet_mueller(*this, wo, wi, [&](int lane) {
    const float eta = wo.z < 0 ? 1 / n[lane] : n[lane];
    if (!through) return reflection_mueller(mirror_cosine(wo, wi), eta, 0.0F);
    const RefractingFacet facet(from_side_of(wo, wo), from_side_of(wo, wi), eta);
    return facet.exists() ? refraction_mueller(facet.cos_rarer_side(eta), eta_from_rarer_side(eta))
                          : MuellerElements<float>{};
  });
}

RoughDielectricMaterial::RoughDielectricMaterial(std::string name, RefractiveIndex inside,
                                                 const Microfacets<float>& facets,
                                                 std::optional<Medium> scattering)
    : index_name(std::move(name)),
      index(std::move(inside)),
      interior_medium(std::move(scattering)),
      surface(make_interface(facets, range_of(index, nullptr))) {}

const RoughInterface& RoughDielectricMaterial::nearest_surface(float low_n, float high_n) const {
  const RoughInterface* nearest = surface.get();
  for (const auto& other : surfaces_in_media)
    if (other->distance_to(low_n, high_n) < nearest->distance_to(low_n, high_n)) nearest = other.get();
  return *nearest;
}

void RoughDielectricMaterial::tabulate_in(const RefractiveIndex& medium) {
  const IndexRange range = range_of(index, &medium);
  if (nearest_surface(range.low, range.high).distance_to(range.low, range.high) > 0)
    surfaces_in_media.push_back(make_interface(surface->facets, range));
}

RoughDielectricBsdf RoughDielectricMaterial::bsdf(const SurfaceLookup& at) const {
  const SampledSpectrum n =
      SampledSpectrum::map(relative_index(index, at.outside, at.wavelengths_nm).n, with_min_contrast);
  if (at.outside == nullptr) return {n, surface.get()};
  return {n, &nearest_surface(n.min(), n.max())};
}

RoughConductorMaterial::RoughConductorMaterial(std::string name, RefractiveIndex metal,
                                               const Microfacets<float>& facets)
    : index_name(std::move(name)),
      index(std::move(metal)),
      mean_reflectance(each_nm([this](double nm) { return diffuse_reflectance(index.n(nm), index.k(nm)); })),
      surface(std::make_shared<RoughMetal>(facets)) {}

RoughConductorBsdf RoughConductorMaterial::bsdf(const SurfaceLookup& at) const {
  SampledSpectrum mean;
  if (at.outside == nullptr) {
    mean = mean_reflectance(at.wavelengths_nm);
  } else {
    const RelativeIndex metal = relative_index(index, at.outside, at.wavelengths_nm);
    mean = SampledSpectrum::map(
        metal.n, metal.k, [](float n, float k) { return static_cast<float>(diffuse_reflectance(n, k)); });
  }
  return {at.wavelengths_nm, mean, &index, at.outside, surface.get()};
}

}  // namespace abbe

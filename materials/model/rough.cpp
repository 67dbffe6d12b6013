#include "materials/model/rough.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "materials/index/relative_index.h"
#include "materials/interface/hemispherical.h"

namespace abbe {
namespace {

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

Curve mean_reflectance_of(const RefractiveIndex& metal) {
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({double(nm), diffuse_reflectance(metal.n(double(nm)), metal.k(double(nm)))});
  return Curve(std::move(knots));
}

}  // namespace

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

Bsdf RoughDielectricMaterial::bsdf(const SurfaceLookup& at) const {
  const SampledSpectrum n =
      SampledSpectrum::map(relative_index(index, at.outside, at.wavelengths_nm).n, with_min_contrast);
  if (at.outside == nullptr) return RoughDielectricBsdf{n, surface.get()};
  return RoughDielectricBsdf{n, &nearest_surface(n.min(), n.max())};
}

RoughConductorMaterial::RoughConductorMaterial(std::string name, RefractiveIndex metal,
                                               const Microfacets<float>& facets)
    : index_name(std::move(name)),
      index(std::move(metal)),
      mean_reflectance(mean_reflectance_of(index)),
      surface(std::make_shared<RoughMetal>(facets)) {}

Bsdf RoughConductorMaterial::bsdf(const SurfaceLookup& at) const {
  SampledSpectrum mean;
  if (at.outside == nullptr) {
    mean = mean_reflectance(at.wavelengths_nm);
  } else {
    const RelativeIndex metal = relative_index(index, at.outside, at.wavelengths_nm);
    mean = SampledSpectrum::map(
        metal.n, metal.k, [](float n, float k) { return static_cast<float>(diffuse_reflectance(n, k)); });
  }
  return RoughConductorBsdf{at.wavelengths_nm, mean, &index, at.outside, surface.get()};
}

}  // namespace abbe

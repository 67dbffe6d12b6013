#include "materials/model/rough.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "materials/index/relative_index.h"
#include "materials/interface/hemispherical.h"

namespace abbe {
namespace {

float apart_from_one(float n) {
  constexpr float kLeastContrast = 1e-3F;
  return std::abs(n - 1) < kLeastContrast ? 1 + std::copysign(kLeastContrast, n - 1) : n;
}

std::shared_ptr<const RoughInterface> boundary(const RefractiveIndex& index,
                                               const Microfacets<float>& facets) {
  auto low = static_cast<float>(index.n(double{kMinWavelengthNm}));
  float high = low;
  for (int nm = kMinWavelengthNm; index.dispersive() && nm <= kMaxWavelengthNm; ++nm) {
    const auto n = static_cast<float>(index.n(double(nm)));
    low = std::min(low, n);
    high = std::max(high, n);
  }
  return std::make_shared<RoughInterface>(facets, apart_from_one(low), apart_from_one(high));
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
      filling(std::move(scattering)),
      surface(boundary(index, facets)) {}

Bsdf RoughDielectricMaterial::bsdf(const SurfaceLookup& at) const {
  const SampledSpectrum n = relative_index(index, at.outside, at.wavelengths_nm).n;
  return RoughDielectricBsdf{SampledSpectrum::map(n, apart_from_one), surface.get(), at.outside == nullptr};
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

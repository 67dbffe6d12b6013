#include "materials/model/rough.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "materials/index/relative_index.h"
#include "materials/interface/fresnel.h"

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

// 2 int_0^1 R(c) c dc by the midpoints of c^2.
Curve mean_reflectance_of(const RefractiveIndex& index) {
  constexpr int kAngles = 64;
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) {
    double sum = 0;
    for (int i = 0; i < kAngles; ++i)
      sum += fresnel_conductor(std::sqrt((i + 0.5) / kAngles), index.n(double(nm)), index.k(double(nm))).R();
    knots.push_back({double(nm), sum / kAngles});
  }
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
  return RoughConductorBsdf{at.wavelengths_nm, &index, at.outside, &mean_reflectance, surface.get()};
}

}  // namespace abbe

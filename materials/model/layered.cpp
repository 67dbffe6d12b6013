#include "materials/model/layered.h"

#include <vector>

#include "materials/index/relative_index.h"
#include "materials/interface/hemispherical.h"

namespace abbe {

Curve inner_reflectance(const RefractiveIndex& index) {
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), diffuse_reflectance_inside(index.n(nm))});
  return Curve(std::move(knots));
}

Bsdf CoatedDiffuseMaterial::bsdf(const SurfaceLookup& at) const {
  const RelativeIndex coat = relative_index(index, at.outside, at.wavelengths_nm);
  const auto back = [](float n) { return static_cast<float>(diffuse_reflectance_inside(n)); };
  return coated_diffuse(coat.n, reflectance(at),
                        at.outside == nullptr ? inner(at.wavelengths_nm) : SampledSpectrum::map(coat.n, back),
                        coat.dispersive);
}

Bsdf ThinGlassMaterial::bsdf(const SurfaceLookup& at) const {
  return ThinGlassBsdf{relative_index(index, at.outside, at.wavelengths_nm).n,
                       index.absorption_per_m(at.wavelengths_nm) * static_cast<float>(thickness)};
}

}  // namespace abbe

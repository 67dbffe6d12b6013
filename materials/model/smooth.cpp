#include "materials/model/smooth.h"

#include "materials/index/relative_index.h"

namespace abbe {

Bsdf DiffuseMaterial::bsdf(const SurfaceLookup& at) const {
  return DiffuseBsdf{reflectance(at)};
}

Bsdf DielectricMaterial::bsdf(const SurfaceLookup& at) const {
  if (!coating.layers.empty()) return CoatedDielectricBsdf{at.wavelengths_nm, &index, &coating, at.outside};
  const RelativeIndex relative = relative_index(index, at.outside, at.wavelengths_nm);
  return DielectricBsdf{relative.n, relative.dispersive};
}

Bsdf FilmMaterial::bsdf(const SurfaceLookup& at) const {
  static const RefractiveIndex kAir(1);
  return CoatedDielectricBsdf{at.wavelengths_nm, at.outside != nullptr ? at.outside : &kAir, &layers,
                              at.outside};
}

Bsdf ConductorMaterial::bsdf(const SurfaceLookup& at) const {
  if (!coating.layers.empty()) return CoatedConductorBsdf{at.wavelengths_nm, &index, &coating, at.outside};
  const RelativeIndex relative = relative_index(index, at.outside, at.wavelengths_nm);
  return ConductorBsdf{relative.n, relative.k};
}

}  // namespace abbe

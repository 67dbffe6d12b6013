#include "materials/model/smooth.h"

namespace abbe {

Bsdf DiffuseMaterial::bsdf(const SurfaceLookup& at) const {
  return DiffuseBsdf{reflectance(at)};
}

Bsdf DielectricMaterial::bsdf(const SurfaceLookup& at) const {
  if (!coating.layers.empty()) return CoatedDielectricBsdf{at.wavelengths_nm, &index, &coating};
  return DielectricBsdf{index.n(at.wavelengths_nm), index.dispersive()};
}

Bsdf ConductorMaterial::bsdf(const SurfaceLookup& at) const {
  if (!coating.layers.empty()) return CoatedConductorBsdf{at.wavelengths_nm, &index, &coating};
  return ConductorBsdf{index.n(at.wavelengths_nm), index.k(at.wavelengths_nm)};
}

}  // namespace abbe

#include "materials/model/classic.h"

namespace abbe {

Bsdf OrenNayarMaterial::bsdf(const SurfaceLookup& at) const {
  return OrenNayarBsdf{reflectance(at), oren_nayar_roughness(sigma_deg)};
}

Bsdf CosinePowerMaterial::bsdf(const SurfaceLookup& at) const {
  const SampledSpectrum rho = reflectance(at);
  const auto a = static_cast<float>(exponent);
  if (reciprocal) return CosinePowerBsdf<true>{rho, a};
  return CosinePowerBsdf<false>{rho, a};
}

Bsdf PhongMaterial::bsdf(const SurfaceLookup& at) const {
  return PhongBsdf{reflectance(at), static_cast<float>(exponent)};
}

Bsdf RetroreflectorMaterial::bsdf(const SurfaceLookup& at) const {
  return RetroreflectorBsdf{reflectance(at), static_cast<float>(exponent)};
}

}  // namespace abbe

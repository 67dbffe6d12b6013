#include <algorithm>
#include <cmath>

#include "materials/bsdf/mirror.h"
#include "materials/bsdf/smooth.h"
#include "materials/interface/fresnel.h"

namespace abbe {
namespace {

// Reflectance for unpolarised light from `wo`.
inline SampledSpectrum reflectance(const ConductorBsdf& metal, const Imath::V3f& wo) {
  const float cos_i = std::min(std::abs(wo.z), 1.0F);
  return SampledSpectrum::map(metal.n, metal.k,
                              [cos_i](float n, float k) { return fresnel_conductor(cos_i, n, k).R(); });
}

}  // namespace

std::optional<BsdfSample> ConductorBsdf::sample(const Imath::V3f& wo, const BsdfRandom& /*u*/, int /*hero*/,
                                                TransportMode /*mode*/) const {
  if (wo.z == 0) return std::nullopt;
  return BsdfSample{.wi = mirrored(wo), .weight = reflectance(*this, wo), .pdf = 1, .delta = true};
}

SampledSpectrum ConductorBsdf::delta_power(const Imath::V3f& wo, bool through) const {
  return through ? SampledSpectrum() : reflectance(*this, wo);
}

}  // namespace abbe

#include <algorithm>
#include <cmath>

#include "materials/bsdf/mirror.h"
#include "materials/bsdf/smooth.h"
#include "materials/interface/fresnel.h"

namespace abbe {

std::optional<BsdfSample> ConductorBsdf::sample(const Imath::V3f& wo, const BsdfRandom& /*u*/, int /*hero*/,
                                                TransportMode /*mode*/) const {
  if (wo.z == 0) return std::nullopt;
  const float cos_i = std::min(std::abs(wo.z), 1.0F);
  const auto reflectance = [cos_i](float n, float k) { return fresnel_conductor(cos_i, n, k).R(); };
  return BsdfSample{
      .wi = mirrored(wo), .weight = SampledSpectrum::map(n, k, reflectance), .pdf = 1, .delta = true};
}

}  // namespace abbe

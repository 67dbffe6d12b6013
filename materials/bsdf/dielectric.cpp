#include <algorithm>
#include <cmath>

#include "materials/bsdf/mirror.h"
#include "materials/bsdf/smooth.h"
#include "materials/interface/fresnel.h"

namespace abbe {
namespace {

// Reflection leaves in the same direction at every wavelength, so the packet stays together: each lane would
// have drawn it with its own reflectance as probability, and carries that share.
BsdfSample reflected(const Imath::V3f& wo, const SampledSpectrum& ratio, float probability) {
  return {.wi = mirrored(wo), .weight = ratio, .lane_pdf = ratio, .pdf = probability, .delta = true};
}

// Refraction goes where the hero goes; the other lanes could not have come along unless the index is the same
// for all.
BsdfSample refracted(const Imath::V3f& wo, const FresnelPower<float>& f, float eta, TransportMode mode) {
  const float probability = 1 - f.R();
  return {.wi = refracted_direction(wo, eta, f.cos_t),
          .weight = SampledSpectrum(f.transmitted() / probability * refraction_scale(eta, mode)),
          .pdf = probability,
          .delta = true,
          .transmitted = true};
}

}  // namespace

float DielectricBsdf::reflectance(const Imath::V3f& wo, int lane) const {
  return fresnel_dielectric(std::min(std::abs(wo.z), 1.0F), eta(wo, lane)).R();
}

std::optional<BsdfSample> DielectricBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const {
  if (wo.z == 0) return std::nullopt;
  const float cos_i = std::min(std::abs(wo.z), 1.0F);
  const bool inside = wo.z < 0;
  const auto fresnel = [&](float n) { return fresnel_dielectric(cos_i, inside ? 1 / n : n); };
  const FresnelPower<float> f = fresnel(n[hero]);
  if (u.lobe >= f.R()) {
    const BsdfSample s = refracted(wo, f, eta(wo, hero), mode);
    return dispersive ? only_lane(s, hero) : s;
  }
  if (!dispersive) return reflected(wo, SampledSpectrum(1), f.R());
  return reflected(wo, SampledSpectrum::map(n, [&](float lane_n) { return fresnel(lane_n).R() / f.R(); }),
                   f.R());
}

}  // namespace abbe

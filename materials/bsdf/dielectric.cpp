#include <algorithm>
#include <cmath>

#include "materials/bsdf/mirror.h"
#include "materials/bsdf/smooth.h"
#include "materials/interface/fresnel.h"

namespace abbe {
namespace {

// Fresnel power for light from `wo` at the surface of a medium of relative index n.
FresnelPower<float> fresnel(const Imath::V3f& wo, float n) {
  return fresnel_dielectric(std::min(std::abs(wo.z), 1.0F), wo.z < 0 ? 1 / n : n);
}

// The reflected direction is the same at every wavelength, so all wavelengths continue. Each draws reflection
// with its own reflectance as probability, which `ratio` contains.
BsdfSample reflected(const Imath::V3f& wo, const SampledSpectrum& ratio, float probability) {
  return {.wi = mirrored(wo), .weight = ratio, .lane_pdf = ratio, .pdf = probability, .delta = true};
}

// Refraction follows the hero wavelength. The other wavelengths can continue only if all have the same index.
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
  return fresnel(wo, n[lane]).R();
}

std::optional<BsdfSample> DielectricBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const {
  if (wo.z == 0) return std::nullopt;
  const FresnelPower<float> f = fresnel(wo, n[hero]);
  if (u.lobe >= f.R()) {
    const BsdfSample s = refracted(wo, f, eta(wo, hero), mode);
    return dispersive ? only_lane(s, hero) : s;
  }
  if (!dispersive) return reflected(wo, SampledSpectrum(1), f.R());
  return reflected(wo, delta_power(wo, false) / SampledSpectrum(f.R()), f.R());
}

SampledSpectrum DielectricBsdf::delta_power(const Imath::V3f& wo, bool through) const {
  return SampledSpectrum::map(n, [&](float lane_n) {
    const FresnelPower<float> f = fresnel(wo, lane_n);
    return through ? f.transmitted() : f.R();
  });
}

}  // namespace abbe

#include <algorithm>
#include <cmath>

#include "materials/bsdf/coated.h"
#include "materials/bsdf/mirror.h"
#include "materials/interface/quotient.h"

namespace abbe {
namespace {

float cosine_of(const Imath::V3f& wo) {
  return std::min(std::abs(wo.z), 1.0F);
}

// Reflectance and transmittance at each wavelength.
struct Powers {
  SampledSpectrum R, T;
};

// Powers of the surface of index n + ik inside, relative to the outside; `inside` if light arrives from
// there.
Powers all_lanes(const CoatingAt& at, const SampledSpectrum& n, const SampledSpectrum& k, float cos_i,
                 bool inside) {
  SampledSpectrum::Values R, T;
  for (int lane = 0; lane < kLanes; ++lane) {
    const FresnelPower<float> f = at.power(lane, n[lane], k[lane], cos_i, inside);
    R[static_cast<std::size_t>(lane)] = f.R();
    T[static_cast<std::size_t>(lane)] = f.transmitted();
  }
  return {SampledSpectrum(R), SampledSpectrum(T)};
}

// An event that all wavelengths can draw, each with probability `part`/(R + T). The hero drew it with
// `probability`.
BsdfSample together(const Imath::V3f& wi, const SampledSpectrum& part, const Powers& powers, int hero,
                    float probability) {
  const SampledSpectrum fractions = quotient(part, powers.R + powers.T);
  return {.wi = wi,
          .weight = part * (1 / probability),
          .lane_pdf = fractions * (1 / fractions[hero]),
          .pdf = probability,
          .delta = true};
}

}  // namespace

// The probability of reflection is R/(R + T), else light is transmitted. The weights contain the absorption
// of the films.
std::optional<BsdfSample> CoatedDielectricBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                       TransportMode mode) const {
  if (wo.z == 0) return std::nullopt;
  const float cos_i = cosine_of(wo);
  const bool inside = wo.z < 0;
  const auto [n, k, dispersive] = relative_index(*index, outside, wavelengths_nm);
  const CoatingAt at(*coating, wavelengths_nm, outside);
  const FresnelPower<float> f = at.power(hero, n[hero], 0, cos_i, inside);
  const float mirrors = quotient(f.R(), f.R() + f.transmitted());
  if (u.lobe < mirrors) {
    const Powers powers = all_lanes(at, n, {}, cos_i, inside);
    return together(mirrored(wo), powers.R, powers, hero, mirrors);
  }
  if (!(f.transmitted() > 0)) return std::nullopt;
  const float eta = inside ? 1 / n[hero] : n[hero];
  const Imath::V3f wi = refracted_direction(wo, eta, f.cos_t);
  BsdfSample s;
  if (dispersive) {
    s = {.wi = wi,
         .weight = SampledSpectrum(f.transmitted() / (1 - mirrors)),
         .pdf = 1 - mirrors,
         .delta = true};
    s = only_lane(s, hero);
  } else {
    const Powers powers = all_lanes(at, n, {}, cos_i, inside);
    s = together(wi, powers.T, powers, hero, 1 - mirrors);
  }
  s.weight *= refraction_scale(eta, mode);
  s.transmitted = true;
  return s;
}

SampledSpectrum CoatedDielectricBsdf::delta_power(const Imath::V3f& wo, bool through) const {
  const SampledSpectrum n = relative_index(*index, outside, wavelengths_nm).n;
  const CoatingAt at(*coating, wavelengths_nm, outside);
  const Powers powers = all_lanes(at, n, {}, cosine_of(wo), wo.z < 0);
  return through ? powers.T : powers.R;
}

std::optional<BsdfSample> CoatedConductorBsdf::sample(const Imath::V3f& wo, const BsdfRandom& /*u*/,
                                                      int /*hero*/, TransportMode /*mode*/) const {
  if (wo.z == 0) return std::nullopt;
  return BsdfSample{.wi = mirrored(wo), .weight = delta_power(wo, false), .pdf = 1, .delta = true};
}

SampledSpectrum CoatedConductorBsdf::delta_power(const Imath::V3f& wo, bool through) const {
  if (through) return {};
  const CoatingAt at(*coating, wavelengths_nm, outside);
  const RelativeIndex relative = relative_index(*index, outside, wavelengths_nm);
  return all_lanes(at, relative.n, relative.k, cosine_of(wo), false).R;
}

}  // namespace abbe

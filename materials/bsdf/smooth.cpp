#include "materials/bsdf/smooth.h"

#include <algorithm>
#include <cmath>

#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"

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

// Fresnel power for light from `wo` at the surface of a medium of relative index n.
FresnelPower<float> fresnel(const Imath::V3f& wo, float n) {
  return fresnel_dielectric(cosine_of(wo), wo.z < 0 ? 1 / n : n);
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

std::optional<BsdfSample> ConductorBsdf::sample(const Imath::V3f& wo, const BsdfRandom& /*u*/, int /*hero*/,
                                                TransportMode /*mode*/) const {
  if (wo.z == 0) return std::nullopt;
  return BsdfSample{.wi = mirrored(wo), .weight = delta_power(wo, false), .pdf = 1, .delta = true};
}

SampledSpectrum ConductorBsdf::delta_power(const Imath::V3f& wo, bool through) const {
  if (through) return {};
  return SampledSpectrum::map(n, k, [cos_i = cosine_of(wo)](float lane_n, float lane_k) {
    return fresnel_conductor(cos_i, lane_n, lane_k).R();
  });
}

float DielectricBsdf::reflectance(const Imath::V3f& wo, int lane) const {
  return fresnel(wo, n[lane]).R();
}

std::optional<BsdfSample> DielectricBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const {
  if (wo.z == 0) return std::nullopt;
  const FresnelPower<float> f = fresnel(wo, n[hero]);
  const float R = f.R();
  if (u.lobe < R) {
    // Each wavelength draws reflection with its own reflectance as probability.
    const SampledSpectrum ratio =
        dispersive ? delta_power(wo, false) / SampledSpectrum(R) : SampledSpectrum(1);
    return BsdfSample{.wi = mirrored(wo), .weight = ratio, .lane_pdf = ratio, .pdf = R, .delta = true};
  }
  // Refraction follows the hero. The other wavelengths can continue only if all have the same index.
  const float relative = eta(wo, hero);
  const BsdfSample s{.wi = refracted_direction(wo, relative, f.cos_t),
                     .weight = SampledSpectrum(f.transmitted() / (1 - R) * refraction_scale(relative, mode)),
                     .pdf = 1 - R,
                     .delta = true,
                     .transmitted = true};
  return dispersive ? only_lane(s, hero) : s;
}

SampledSpectrum DielectricBsdf::delta_power(const Imath::V3f& wo, bool through) const {
  return SampledSpectrum::map(n, [&](float lane_n) {
    const FresnelPower<float> f = fresnel(wo, lane_n);
    return through ? f.transmitted() : f.R();
  });
}

std::variant<DielectricBsdf, CoatedDielectricBsdf> DielectricMaterial::bsdf(const SurfaceLookup& at) const {
  if (!coating.layers.empty()) return CoatedDielectricBsdf{at.wavelengths_nm, &index, &coating, at.outside};
  const RelativeIndex relative = relative_index(index, at.outside, at.wavelengths_nm);
  return DielectricBsdf{relative.n, relative.dispersive};
}

CoatedDielectricBsdf FilmMaterial::bsdf(const SurfaceLookup& at) const {
  static const RefractiveIndex kAir(1);
  return {at.wavelengths_nm, at.outside != nullptr ? at.outside : &kAir, &layers, at.outside};
}

std::variant<ConductorBsdf, CoatedConductorBsdf> ConductorMaterial::bsdf(const SurfaceLookup& at) const {
  if (!coating.layers.empty()) return CoatedConductorBsdf{at.wavelengths_nm, &index, &coating, at.outside};
  const RelativeIndex relative = relative_index(index, at.outside, at.wavelengths_nm);
  return ConductorBsdf{relative.n, relative.k};
}

std::optional<MuellerMatrix> DielectricBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& wi,
                                                     bool /*delta*/, std::optional<int> lane) const {
  const float cos_i = cosine_of(wo);
  const bool through = wo.z * wi.z < 0;
  return mueller_of_surface(wo, dispersive ? lane : std::optional(0), [&](int j) {
    const float relative = eta(wo, j);
    return through ? refraction_mueller(cos_i, relative) : reflection_mueller(cos_i, relative, 0.0F);
  });
}

std::optional<MuellerMatrix> ConductorBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& /*wi*/,
                                                    bool /*delta*/, std::optional<int> lane) const {
  const float cos_i = cosine_of(wo);
  return mueller_of_surface(wo, lane, [&](int j) { return reflection_mueller(cos_i, n[j], k[j]); });
}

std::optional<MuellerMatrix> CoatedDielectricBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& wi,
                                                           bool /*delta*/, std::optional<int> lane) const {
  const SampledSpectrum n = relative_index(*index, outside, wavelengths_nm).n;
  const CoatingAt at(*coating, wavelengths_nm, outside);
  const float cos_i = cosine_of(wo);
  const bool through = wo.z * wi.z < 0;
  return mueller_of_surface(wo, lane, [&](int j) {
    const InterfaceMueller<float> films = at.mueller(j, n[j], 0, cos_i, wo.z < 0);
    return through ? films.through : films.reflected;
  });
}

std::optional<MuellerMatrix> CoatedConductorBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& /*wi*/,
                                                          bool /*delta*/, std::optional<int> lane) const {
  const RelativeIndex relative = relative_index(*index, outside, wavelengths_nm);
  const CoatingAt at(*coating, wavelengths_nm, outside);
  const float cos_i = cosine_of(wo);
  return mueller_of_surface(
      wo, lane, [&](int j) { return at.mueller(j, relative.n[j], relative.k[j], cos_i, false).reflected; });
}

std::optional<FresnelPower<double>> DielectricMaterial::smooth_power(const SmoothLookup& at) const {
  return coated_power(coating, at.wavelength_nm, index.n(at.wavelength_nm), 0, at.cos_i, at.inside,
                      at.outside);
}

SmoothMueller DielectricMaterial::smooth_mueller(const SmoothLookup& at) const {
  return {coated_mueller(coating, at.wavelength_nm, index.n(at.wavelength_nm), 0, at.cos_i, at.inside,
                         at.outside)};
}

std::optional<FresnelPower<double>> FilmMaterial::smooth_power(const SmoothLookup& at) const {
  return coated_power(layers, at.wavelength_nm, at.outside, 0, at.cos_i, at.inside, at.outside);
}

SmoothMueller FilmMaterial::smooth_mueller(const SmoothLookup& at) const {
  return {coated_mueller(layers, at.wavelength_nm, at.outside, 0, at.cos_i, at.inside, at.outside)};
}

std::optional<FresnelPower<double>> ConductorMaterial::smooth_power(const SmoothLookup& at) const {
  return without_transmission(coated_power(coating, at.wavelength_nm, index.n(at.wavelength_nm),
                                           index.k(at.wavelength_nm), at.cos_i, false, at.outside));
}

SmoothMueller ConductorMaterial::smooth_mueller(const SmoothLookup& at) const {
  return {coated_mueller(coating, at.wavelength_nm, index.n(at.wavelength_nm), index.k(at.wavelength_nm),
                         at.cos_i, false, at.outside)};
}

// A bare metal with n = 0 absorbs nothing and reflects s and p alike. A coating may absorb one more than the
// other.
bool ConductorMaterial::preserves_polarisation() const {
  if (!coating.layers.empty()) return false;
  for (double lambda_nm = kMinWavelengthNm; lambda_nm <= kMaxWavelengthNm; ++lambda_nm)
    if (index.n(lambda_nm) > 0) return false;
  return true;
}

}  // namespace abbe

#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"

namespace abbe {

/// Mirrors that no real material has, for teaching and for comparisons. Both sides reflect alike, as do s and
/// p: `ideal` is R/cos delta, with the same reflectance at every angle [Marschner2021, sec. 14.1], `schlick`
/// is Schlick's approximation instead of Fresnel's equations [Schlick1994].
enum class MirrorKind { ideal, schlick };

template <MirrorKind Kind>
struct IdealMirrorBsdf {
  SampledSpectrum reflectance;  ///< In [0, 1]; along the normal for `schlick`.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& /*u*/, int /*hero*/,
                                                 TransportMode /*mode*/) const {
    if (wo.z == 0) return std::nullopt;
    return BsdfSample{.wi = mirrored(wo), .weight = delta_power(wo, false), .pdf = 1, .delta = true};
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const {
    if (through) return {};
    if constexpr (Kind == MirrorKind::ideal) return reflectance;
    const float cos_i = std::min(std::abs(wo.z), 1.0F);
    return SampledSpectrum::map(reflectance, [cos_i](float r0) { return schlick(cos_i, r0); });
  }
  [[nodiscard]] static std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& /*wi*/,
                                                            bool /*delta*/, std::optional<int> /*lane*/) {
    return mueller_of_surface(wo, 0, [](int /*lane*/) { return kIdealMirror<float>; });
  }
};
using MirrorBsdf = IdealMirrorBsdf<MirrorKind::ideal>;
using SchlickBsdf = IdealMirrorBsdf<MirrorKind::schlick>;

/// A mirror of this kind; `reflectance` is that of its BSDF.
template <MirrorKind Kind>
struct IdealMirrorMaterial : OpaqueSurface {
  [[nodiscard]] IdealMirrorBsdf<Kind> bsdf(const SurfaceLookup& at) const { return {reflectance(at)}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool preserves_polarisation() { return true; }
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const {
    const std::optional<double> value = reflectance.at(at.wavelength_nm, at.coordinates);
    if (!value) return std::nullopt;
    const double r = Kind == MirrorKind::ideal ? *value : schlick(at.cos_i, *value);
    return FresnelPower<double>{r, r, 0, 0, 0};
  }
  [[nodiscard]] static SmoothMueller smooth_mueller(const SmoothLookup& /*at*/) {
    return {{kIdealMirror<double>, {}}};
  }
};
using MirrorMaterial = IdealMirrorMaterial<MirrorKind::ideal>;
using SchlickMaterial = IdealMirrorMaterial<MirrorKind::schlick>;

}  // namespace abbe

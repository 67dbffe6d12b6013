#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "materials/bsdf/event.h"
#include "materials/bsdf/surface.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"

namespace abbe {

// Mirrors that no real material has, for teaching and for comparisons. Both sides reflect alike.

/// Mueller matrix of a smooth surface that reflects s and p alike.
[[nodiscard]] inline MuellerMatrix ideal_mirror_mueller(const Imath::V3f& wo) {
  return mueller_of_surface(wo, 0, [](int /*lane*/) { return kIdealMirror<float>; });
}

/// The ideal mirror R/cos delta, with the same reflectance at every angle. [Marschner2021, sec. 14.1]
struct MirrorBsdf {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum reflectance;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& /*u*/, int /*hero*/,
                                                 TransportMode /*mode*/) const {
    if (wo.z == 0) return std::nullopt;
    return BsdfSample{.wi = mirrored(wo), .weight = reflectance, .pdf = 1, .delta = true};
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& /*wo*/, bool through) const {
    return through ? SampledSpectrum() : reflectance;
  }
  [[nodiscard]] static std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& /*wi*/,
                                                            bool /*delta*/, std::optional<int> /*lane*/) {
    return ideal_mirror_mueller(wo);
  }
};

/// A smooth surface by Schlick's approximation instead of Fresnel's equations. [Schlick1994]
struct SchlickBsdf {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum r0;  ///< Reflectance along the normal, in [0, 1].

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& /*u*/, int /*hero*/,
                                                 TransportMode /*mode*/) const {
    if (wo.z == 0) return std::nullopt;
    return BsdfSample{.wi = mirrored(wo), .weight = delta_power(wo, false), .pdf = 1, .delta = true};
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const {
    if (through) return {};
    return SampledSpectrum::map(r0, [c = std::min(std::abs(wo.z), 1.0F)](float r) { return schlick(c, r); });
  }
  [[nodiscard]] static std::optional<MuellerMatrix> mueller(const Imath::V3f& wo, const Imath::V3f& /*wi*/,
                                                            bool /*delta*/, std::optional<int> /*lane*/) {
    return ideal_mirror_mueller(wo);
  }
};

/// The ideal mirror with the same `reflectance` at every angle.
struct MirrorMaterial : OpaqueSurface {
  [[nodiscard]] MirrorBsdf bsdf(const SurfaceLookup& at) const { return {reflectance(at)}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool preserves_polarisation() { return true; }
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
};

/// A mirror by Schlick's approximation; `reflectance` is its value along the normal.
struct SchlickMaterial : OpaqueSurface {
  [[nodiscard]] SchlickBsdf bsdf(const SurfaceLookup& at) const { return {reflectance(at)}; }
  [[nodiscard]] static constexpr Lobes lobes() { return {.delta = true}; }
  [[nodiscard]] static constexpr bool preserves_polarisation() { return true; }
  [[nodiscard]] std::optional<FresnelPower<double>> smooth_power(const SmoothLookup& at) const;
  [[nodiscard]] SmoothMueller smooth_mueller(const SmoothLookup& at) const;
};

}  // namespace abbe

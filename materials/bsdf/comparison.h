#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "materials/bsdf/mirror.h"
#include "materials/interface/fresnel.h"

namespace abbe {

/// Mirrors that no real material has, for teaching and for comparisons. Both sides reflect alike.

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
  [[nodiscard]] static SampledSpectrum delta_probability(const Imath::V3f& /*wo*/) {
    return SampledSpectrum(1);
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& /*wo*/, bool through) const {
    return through ? SampledSpectrum() : reflectance;
  }
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
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
  [[nodiscard]] static SampledSpectrum delta_probability(const Imath::V3f& /*wo*/) {
    return SampledSpectrum(1);
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const {
    if (through) return {};
    return SampledSpectrum::map(r0, [c = std::min(std::abs(wo.z), 1.0F)](float r) { return schlick(c, r); });
  }
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe

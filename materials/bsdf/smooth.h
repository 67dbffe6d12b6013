#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// A smooth dielectric interface with its normal towards the outside.
struct DielectricBsdf {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum n;  ///< Inside index relative to the outside.
  /// True if n may differ between wavelengths; then only the hero continues after refraction.
  bool dispersive;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] static SampledSpectrum delta_probability(const Imath::V3f& /*wo*/) {
    return SampledSpectrum(1);
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] float index_inside(int lane) const { return n[lane]; }
  /// Index of the far side divided by that of the side of `wo`.
  [[nodiscard]] float eta(const Imath::V3f& wo, int lane) const { return wo.z < 0 ? 1 / n[lane] : n[lane]; }
  /// Reflectance for unpolarised light.
  [[nodiscard]] float reflectance(const Imath::V3f& wo, int lane) const;
};

/// A smooth conductor, opaque, reflecting on both sides.
struct ConductorBsdf {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum n;  ///< Real part of the index relative to the outside.
  SampledSpectrum k;  ///< Imaginary part of that index, 0 or more.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] static SampledSpectrum delta_probability(const Imath::V3f& /*wo*/) {
    return SampledSpectrum(1);
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe

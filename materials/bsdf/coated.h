#pragma once

#include <optional>

#include "materials/bsdf/event.h"
#include "materials/index/relative_index.h"
#include "materials/interface/coating.h"

namespace abbe {

/// A smooth dielectric interface under thin films, which may absorb. It refers to the material, which must
/// outlive it, and holds the wavelengths of the packet. Films do not scatter; they absorb what they neither
/// reflect nor transmit.
struct CoatedDielectricBsdf {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum wavelengths_nm;  ///< Wavelengths in standard air [nm].
  const RefractiveIndex* index;    ///< Index inside; its k is ignored.
  const Coating* coating;
  const RefractiveIndex* outside = nullptr;  ///< Medium outside; nullptr is air.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] static SampledSpectrum delta_probability(const Imath::V3f& /*wo*/) {
    return SampledSpectrum(1);
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] float index_inside(int lane) const {
    return relative_index(*index, outside, wavelengths_nm).n[lane];
  }
};

/// A smooth conductor under thin films, opaque, reflecting on both sides. It refers to the material, which
/// must outlive it.
struct CoatedConductorBsdf {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum wavelengths_nm;  ///< Wavelengths in standard air [nm].
  const RefractiveIndex* index;    ///< Complex index of the conductor.
  const Coating* coating;
  const RefractiveIndex* outside = nullptr;  ///< Medium outside; nullptr is air.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] static SampledSpectrum delta_probability(const Imath::V3f& /*wo*/) {
    return SampledSpectrum(1);
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe

#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// A sheet of clear or tinted glass with the same outside on both sides, by `sheet_power`: light is reflected
/// or passes straight on. All wavelengths go the same ways.
struct ThinGlassBsdf {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum n;      ///< Relative to the outside.
  SampledSpectrum depth;  ///< -ln a of the passage along the normal.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum delta_probability(const Imath::V3f& wo) const;  ///< 0 where nothing leaves.
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe

#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// A sheet of transparent or absorbing glass with the same medium on both sides, by `sheet_power`. It
/// reflects light or transmits it undeflected, in the same directions at all wavelengths.
struct ThinGlassBsdf {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum n;      ///< Relative to the outside.
  SampledSpectrum depth;  ///< Optical depth -ln a along the normal.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum delta_probability(const Imath::V3f& wo) const;  ///< 0 if no light leaves.
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe

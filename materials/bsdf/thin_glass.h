#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// A sheet of transparent or absorbing glass with the same medium on both sides. It reflects light or
/// transmits it undeflected, in the same directions at all wavelengths. Its powers include all reflections
/// between the faces, without interference (`sheet_power`).
struct ThinGlassBsdf {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum n;  ///< Index relative to the medium outside.
  /// Optical depth of one passage along the normal, 0 or more: -ln a, where a is the internal transmittance.
  SampledSpectrum depth;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  /// Probability of a delta event: 1, or 0 at wavelengths at which no light leaves.
  [[nodiscard]] SampledSpectrum delta_probability(const Imath::V3f& wo) const;
  /// Transmittance of the sheet if `through`, else its reflectance.
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& wo, bool through) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe

#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// A sheet of clear or tinted glass with the same outside on both sides: light is reflected or passes
/// straight on, the reflections between its faces summed without interference, s and p apart,
///
///   R = r + t^2 r a^2/(1 - r^2 a^2),  T = t^2 a/(1 - r^2 a^2),
///
/// with r + t = 1 of one face and a what is left after one passage inside. All wavelengths go the same ways.
/// [Stokes1862]
struct ThinGlassBsdf {
  static constexpr bool kScatters = false;

  SampledSpectrum n;      ///< Relative to the outside.
  SampledSpectrum depth;  ///< -ln a of the passage along the normal.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe

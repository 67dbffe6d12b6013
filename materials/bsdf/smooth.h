#pragma once

#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// Smooth dielectric interface with the normal towards the outside; `n` is the inside index relative to the
/// outside.
struct DielectricBsdf {
  static constexpr bool kScatters = false;

  SampledSpectrum n;
  bool dispersive;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] float index_inside(int lane) const { return n[lane]; }
};

/// Smooth conductor, opaque, reflecting on both sides.
struct ConductorBsdf {
  static constexpr bool kScatters = false;

  SampledSpectrum n;
  SampledSpectrum k;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

}  // namespace abbe

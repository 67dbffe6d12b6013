#pragma once

#include <cmath>
#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// Thin sheets that change the polarisation of light and let it straight on, from both sides alike: what they
/// reflect is left out. Axes lie in the surface, x being along u; of light that comes at an angle they are
/// their projections across it.

/// What all of them are to light that is not polarised.
struct ThinElement {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum transmittance;  ///< Of unpolarised light.

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& /*u*/, int /*hero*/,
                                                 TransportMode /*mode*/) const {
    if (wo.z == 0) return std::nullopt;
    return BsdfSample{.wi = -wo, .weight = transmittance, .pdf = 1, .delta = true, .transmitted = true};
  }
  [[nodiscard]] static SampledSpectrum delta_probability(const Imath::V3f& /*wo*/) {
    return SampledSpectrum(1);
  }
  [[nodiscard]] SampledSpectrum delta_power(const Imath::V3f& /*wo*/, bool through) const {
    return through ? transmittance : SampledSpectrum();
  }
  [[nodiscard]] static constexpr float index_inside(int /*lane*/) { return 1; }
};

/// A linear polariser; what it does not let pass it absorbs.
struct PolariserBsdf : ThinElement {
  SampledSpectrum blocked;  ///< Transmittance across the axis over that along it, in [0, 1].
  Imath::V2f axis;          ///< Unit vector along which fields pass.
};

/// A wave plate.
struct WavePlateBsdf : ThinElement {
  SampledSpectrum retardance;  ///< Of fields across the fast axis behind those along it [rad].
  Imath::V2f axis;             ///< Unit vector along the fast axis.
};

/// A sheet that light leaves unpolarised.
struct DepolariserBsdf : ThinElement {};

}  // namespace abbe

#pragma once

#include <cmath>
#include <optional>

#include "materials/bsdf/event.h"

namespace abbe {

/// Thin sheets that change the polarisation of light and transmit it undeflected, alike from both sides. They
/// do not reflect. Axes lie in the surface, with x along u. At oblique incidence the effective axis is the
/// projection perpendicular to the ray.

/// The part common to all thin elements: their action on unpolarised light.
struct ThinElement {
  static constexpr bool kScatters = false;
  static constexpr bool kDelta = true;

  SampledSpectrum transmittance;  ///< Transmittance of unpolarised light, in [0, 1].

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

/// A linear polariser. It absorbs what it does not transmit.
struct PolariserBsdf : ThinElement {
  SampledSpectrum blocked;  ///< Transmittance perpendicular to the axis divided by that along it, in [0, 1].
  Imath::V2f axis;          ///< Unit vector along which fields are transmitted.
};

/// A wave plate.
struct WavePlateBsdf : ThinElement {
  SampledSpectrum retardance;  ///< Phase lag of fields perpendicular to the fast axis [rad].
  Imath::V2f axis;             ///< Unit vector along the fast axis.
};

/// A sheet that depolarises the light it transmits.
struct DepolariserBsdf : ThinElement {};

}  // namespace abbe

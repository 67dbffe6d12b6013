#pragma once

#include <optional>
#include <variant>

#include <ImathVec.h>

#include "materials/interface/mueller.h"

namespace abbe {

/// Phase functions: the pdf of the scattered direction over the sphere [1/sr], the same for all wavelengths.

/// Isotropic scattering.
struct IsotropicPhase {};
/// The Henyey-Greenstein phase function. g in (-1, 1) is the mean cosine of the deflection: g > 0 scatters
/// forwards, g < 0 backwards. [HenyeyGreenstein1941, eq. 2]
struct HenyeyGreensteinPhase {
  float g;
};
/// Rayleigh scattering by particles small against the wavelength: 3/(16 pi) (1 + cos^2). [Chandrasekhar1960,
/// sec. 3]
struct RayleighPhase {};

/// The closed list of phase functions.
using PhaseFunction = std::variant<IsotropicPhase, HenyeyGreensteinPhase, RayleighPhase>;

/// A sampled direction in a frame with z along the direction of the arriving light, and its pdf [1/sr].
struct PhaseSample {
  Imath::V3f direction;
  float pdf;
};
/// Samples exactly from the phase function, so the path throughput is unchanged. `u` is in [0, 1)^2.
[[nodiscard]] PhaseSample sample(const PhaseFunction& phase, const Imath::V2f& u);

/// Pdf [1/sr] of scattering light from the unit vector `from`, its direction of travel, to the unit vector
/// `to`.
[[nodiscard]] float pdf(const PhaseFunction& phase, const Imath::V3f& from, const Imath::V3f& to);

/// Mueller matrix of the scattering between unit vectors `from` and `to`, both directions of travel; the
/// phase function itself is not included. Empty if it depolarises, as all but Rayleigh scattering are assumed
/// to.
[[nodiscard]] std::optional<MuellerMatrix> mueller(const PhaseFunction& phase, const Imath::V3f& from,
                                                   const Imath::V3f& to);

}  // namespace abbe

#pragma once

#include <optional>
#include <variant>

#include <ImathVec.h>

#include "materials/interface/mueller.h"

namespace abbe {

/// How matter scatters light: the density of the new direction over the sphere [1/sr], the same for all
/// wavelengths.

/// Scatters into all directions alike.
struct IsotropicPhase {};
/// Forwards for g > 0, backwards for g < 0; g in (-1, 1) is the mean cosine of the angle turned by.
/// [HenyeyGreenstein1941, eq. 2]
struct HenyeyGreensteinPhase {
  float g;
};
/// Scattering by what is small against the wavelength: 3/(16 pi) (1 + cos^2). [Chandrasekhar1960, sec. 3]
struct RayleighPhase {};

/// The closed list.
using PhaseFunction = std::variant<IsotropicPhase, HenyeyGreensteinPhase, RayleighPhase>;

/// A drawn direction, z along the way light came, and its density [1/sr].
struct PhaseSample {
  Imath::V3f direction;
  float pdf;
};
/// Drawn exactly by the phase function, so that scattering keeps the lanes as they are. `u` in [0, 1)^2.
[[nodiscard]] PhaseSample sample(const PhaseFunction& phase, const Imath::V2f& u);

/// Density with which light that travels along the unit vector `from` is turned to the unit vector `to`
/// [1/sr].
[[nodiscard]] float pdf(const PhaseFunction& phase, const Imath::V3f& from, const Imath::V3f& to);

/// What that does to polarisation; nothing where it depolarises, as all but Rayleigh scattering are taken to.
[[nodiscard]] std::optional<MuellerMatrix> mueller(const PhaseFunction& phase, const Imath::V3f& from,
                                                   const Imath::V3f& to);

}  // namespace abbe

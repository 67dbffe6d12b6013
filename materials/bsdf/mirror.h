#pragma once

#include <cmath>

#include "materials/bsdf/event.h"

namespace abbe {

/// Functions shared by the smooth models.

/// Mirror direction of the local direction `wo`.
[[nodiscard]] inline Imath::V3f mirrored(const Imath::V3f& wo) {
  return {-wo.x, -wo.y, wo.z};
}

/// Local direction into which light from `wo` is refracted, away from the surface on the other side. eta =
/// n_t/n_i, with n_i on the side of `wo`; `cos_t` > 0 is the cosine of the refracted angle.
[[nodiscard]] inline Imath::V3f refracted_direction(const Imath::V3f& wo, float eta, float cos_t) {
  return {-wo.x / eta, -wo.y / eta, std::copysign(cos_t, -wo.z)};
}

/// Factor by which refraction scales the quantity of a path: 1/eta^2 for radiance, 1 for power. eta =
/// n_t/n_i, with n_i on the side of wo.
[[nodiscard]] inline float refraction_scale(float eta, TransportMode mode) {
  return mode == TransportMode::radiance ? 1 / (eta * eta) : 1.0F;
}

/// `s` restricted to the hero wavelength and marked as dispersive, for directions that the other wavelengths
/// cannot take.
[[nodiscard]] inline BsdfSample only_lane(BsdfSample s, int hero) {
  s.weight = SampledSpectrum::only(hero, s.weight[hero]);
  s.lane_pdf = SampledSpectrum::only(hero, 1);
  s.dispersive = true;
  return s;
}

}  // namespace abbe

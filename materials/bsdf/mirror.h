#pragma once

#include <cmath>

#include "materials/bsdf/event.h"

namespace abbe {

/// What smooth surfaces have in common.

[[nodiscard]] inline Imath::V3f mirrored(const Imath::V3f& wo) {
  return {-wo.x, -wo.y, wo.z};
}

/// Through the surface, eta = n_t/n_i, cos_t of the refracted angle.
[[nodiscard]] inline Imath::V3f refracted_direction(const Imath::V3f& wo, float eta, float cos_t) {
  return {-wo.x / eta, -wo.y / eta, std::copysign(cos_t, -wo.z)};
}

/// What refraction does to the quantity carried.
[[nodiscard]] inline float refraction_scale(float eta, TransportMode mode) {
  return mode == TransportMode::radiance ? 1 / (eta * eta) : 1.0F;
}

/// `s` for the hero alone: the other lanes could not have come along.
[[nodiscard]] inline BsdfSample only_lane(BsdfSample s, int hero) {
  s.weight = SampledSpectrum::only(hero, s.weight[hero]);
  s.lane_pdf = SampledSpectrum::only(hero, 1);
  s.dispersive = true;
  return s;
}

}  // namespace abbe

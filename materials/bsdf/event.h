#pragma once

#include <cmath>

#include <ImathVec.h>

#include "spectral/sampled_spectrum.h"

namespace abbe {

/// The quantity that a path carries: radiance from the camera, or power (the adjoint of importance) from a
/// light. Refraction scales radiance by 1/eta^2 and leaves power unchanged; eta is the index on the side of
/// wi divided by that on the side of wo.
enum class TransportMode { radiance, power };

/// Random numbers of one scattering event, each in [0, 1).
struct BsdfRandom {
  float lobe;            ///< Selects the lobe, such as reflection or transmission.
  Imath::V2f direction;  ///< Selects the direction within a lobe.
};

/// A sampled scattering event. Directions are local unit vectors: z points along the outward normal, and x
/// along dp/du if the material `needs_coordinates`, else anywhere in the surface. The given direction wo and
/// the sampled wi both point away from the surface.
///
/// The hero wavelength drew the direction. `weight` is f |cos wi|/pdf(hero) at each wavelength; for a delta
/// event, the fraction of light that it carries divided by its probability. `lane_pdf` is
/// pdf(wavelength)/pdf(hero), with which transport applies MIS over wavelengths. Both are 0 at wavelengths
/// that cannot scatter into this direction.
struct BsdfSample {
  Imath::V3f wi;
  SampledSpectrum weight;
  SampledSpectrum lane_pdf{1.0F};
  float pdf = 0;             ///< Pdf of wi at the hero wavelength [1/sr]; for a delta event its probability.
  bool delta = false;        ///< True if wi has a finite probability, as in a mirror.
  bool transmitted = false;  ///< True if wi is on the other side of the surface than wo.
  bool dispersive = false;   ///< True if wi depends on wavelength, so that only the hero continues.
};

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

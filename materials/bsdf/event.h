#pragma once

#include <ImathVec.h>

#include "spectral/sampled_spectrum.h"

namespace abbe {

/// The quantity that a path carries: radiance from the camera, or power (the adjoint of importance) from a
/// light. Refraction scales radiance by 1/eta^2 and leaves power unchanged.
enum class TransportMode { radiance, power };

/// Random numbers of one scattering event.
struct BsdfRandom {
  float lobe;
  Imath::V2f direction;
};

/// A sampled scattering event. Directions are local: z points along the normal, and both directions point
/// away from the surface.
///
/// The hero wavelength drew the direction. `weight` is f |cos wi| / pdf(hero) at each wavelength. `lane_pdf`
/// is pdf(wavelength)/pdf(hero), with which transport applies MIS over wavelengths. Both are 0 at wavelengths
/// that cannot scatter into this direction.
struct BsdfSample {
  Imath::V3f wi;
  SampledSpectrum weight;
  SampledSpectrum lane_pdf{1.0F};
  float pdf = 0;  ///< Pdf of wi at the hero wavelength [1/sr]; for a delta event its probability.
  bool delta = false;
  bool transmitted = false;
  bool dispersive = false;  ///< True if wi depends on wavelength, so that only the hero continues.
};

}  // namespace abbe

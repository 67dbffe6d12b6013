#pragma once

#include <ImathVec.h>

#include "spectral/packet.h"

namespace abbe {

/// Which quantity a path carries: radiance (from the camera) or importance's adjoint, power (from a light).
/// Refraction scales radiance by 1/eta^2 and leaves power alone.
enum class TransportMode { radiance, power };

/// Random numbers of one scattering event.
struct BsdfRandom {
  float lobe;
  Imath::V2f direction;
};

/// One scattering event. Directions are local: z along the normal, both away from the surface.
///
/// The direction was drawn by the hero lane. `weight` is f |cos wi| / pdf(hero), lane by lane; `lane_pdf` is
/// pdf(lane)/pdf(hero), so that transport can balance the lanes. Lanes that could not have taken this
/// direction have weight and lane_pdf 0.
struct BsdfSample {
  Imath::V3f wi;
  SampledSpectrum weight;
  SampledSpectrum lane_pdf{1.0F};
  float pdf = 0;  ///< Density of wi for the hero [1/sr]; for a delta event the probability of the event.
  bool delta = false;
  bool transmitted = false;
  bool dispersive = false;  ///< wi depends on wavelength: only the hero follows.
};

}  // namespace abbe

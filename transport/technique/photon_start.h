#pragma once

#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"

namespace abbe {

/// How a photon sets out: its power is the light's emission times `factor`, 0 if it gets nowhere.
struct PhotonRay {
  Ray ray;
  float factor = 0;
  int cell = -1;  ///< Of the light's aim, or -1.
};

/// The random numbers a photon starts by, in [0, 1).
struct PhotonRandom {
  Imath::V2f aim;    ///< A direction, or a point aimed at.
  Imath::V2f start;  ///< A point of the light, or of a sun.
  float choice;      ///< Between target and emission.
  float time;        ///< Within the exposure.
};

/// Starts a photon of the light that was picked.
[[nodiscard]] PhotonRay start_photon(const Plan& plan, RayCaster& caster,
                                     const PowerLightSampler::SampledLight& pick, const PhotonRandom& u);

}  // namespace abbe

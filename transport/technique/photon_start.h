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

/// The random numbers of that, in [0, 1).
struct PhotonRandom {
  Imath::V2f aim;    ///< A direction, or a point aimed at.
  Imath::V2f start;  ///< A point of the light, or of a sun.
  float choice;      ///< Between target and emission.
};

/// A photon of the light that was picked.
///
/// From a light that is near, by a point of it and a direction from there. Of one that is far, or at
/// infinity, the rays are as good as parallel, and a float would not tell them apart at its place: there the
/// second choice is a point x of the target of the light's aim, with density p(x) [1/m^2]. With radiance L
/// from the unit direction -w, dA cos(x) L dw is what passes; a photon stands for
///     L cos(x)/(p(x) p(w))            from a sun,
///     E cos(x)/p(x)                   of a directional light of irradiance E,
///     L cos(x) cos(y)/(p(x) p(y) d^2) from the point y of a lamp at the distance d,
///     I cos(x)/(p(x) d^2)             of a point or spot light.
/// It starts before all it may be bent by, if nothing stands between there and the light.
[[nodiscard]] PhotonRay start_photon(const Plan& plan, RayCaster& caster,
                                     const PowerLightSampler::SampledLight& pick, const PhotonRandom& u);

}  // namespace abbe

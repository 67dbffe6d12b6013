#pragma once

#include <functional>
#include <span>

#include "sampling/sampler.h"
#include "transport/path/exposure.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Receives what one connection adds to a pixel, one value per channel.
using Splat = std::function<void(int x, int y, std::span<const double> values)>;

/// How a photon left its light.
struct PhotonStart {
  std::uint32_t light = 0;
  int cell = -1;  ///< Aim cell, or -1.
};

/// One path from a traced light, connected to the camera at every vertex that is not specular. A photon whose
/// first vertex is not specular is not followed, as path tracing owns it, unless `plan.light_owns_all`.
/// `share` is the part of a sample per pixel one photon stands for (1/pixels when a sample per pixel is as
/// many photons as pixels).
PhotonStart trace_photon(const Plan& plan, RayCaster& caster, const Sampler& sampler, double share,
                         PathExposure& exposure, const Splat& splat);

}  // namespace abbe

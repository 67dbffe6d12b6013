#pragma once

#include "sampling/sampler.h"
#include "transport/path/exposure.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"

namespace abbe {

/// One camera path through pixel (x, y): path tracing with light sampling at every vertex that is not
/// specular, balanced over techniques and lanes, and Russian roulette. Adds to `values`, one per channel, the
/// exposure the path found: what it owns by `plan`.
///
/// Owned: every path that ends on an area or environment light or by light sampling, except those whose
/// vertex next to the camera is not specular while the one next to a traced light is.
void trace_camera_path(const Plan& plan, RayCaster& caster, const Sampler& sampler, int x, int y,
                       PathExposure& exposure);

}  // namespace abbe

#pragma once

#include "transport/plan/plan.h"

namespace abbe {

/// Trains the caustic guides of a plan that traces camera paths. The pilot photons come from lights that
/// camera paths may hit through specular surfaces. Does nothing for a scene without caustics. The result does
/// not depend on `threads`, which is at least 1.
void train_caustic_guides(Plan& plan, int threads);

}  // namespace abbe

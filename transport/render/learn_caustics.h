#pragma once

#include "transport/plan/plan.h"

namespace abbe {

/// Teaches a plan that traces paths where to look for caustics, by photons from the lights that camera paths
/// may meet through specular matter.
void learn_caustics(Plan& plan, int threads);

}  // namespace abbe

#pragma once

#include "transport/plan/plan.h"

namespace abbe {

/// Sets into how many a camera path of Integrator::automatic goes on where it first scatters: 1, 2, 4 or 8,
/// whichever leaves least error for what it costs. [Arvo1990] Those of Integrator::path are whole, as ways of
/// sampling are compared by them.
///
/// Where light that a path finds later is the noise of a pixel, and not where it goes through film, lens and
/// the first surface, several directions from there cost less than as many paths. Pilots trace each way 32
/// paths through each of 512 pixels, in four replicates, by random numbers of no render, and compare their
/// relMSE, without the worst pixels, times the rays that they cast. More must be better by a fiftieth, and
/// none are tried beyond what is worse by one. Depends on nothing but the plan. Films of fewer than 8192
/// pixels and plans without path tracing keep 1 too, and no more is tried than `rays_of_pilots` allows.
void learn_splitting(Plan& plan, int threads);

}  // namespace abbe

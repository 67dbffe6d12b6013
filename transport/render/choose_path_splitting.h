#pragma once

#include "transport/plan/plan.h"

namespace abbe {

/// Sets `Plan::log2_splits`, the path splitting [Arvo1990] of Integrator::automatic: the base-2 logarithm of
/// the number of directions, 1, 2, 4 or 8, in which a camera path continues from its first scattering
/// surface. Integrator::path does not split, because its sampling techniques are compared with one another.
///
/// Splitting saves rays if the noise of a pixel comes from later vertices, and not from film, lens and first
/// surface. For each number, pilots trace 32 paths through each of 512 pixels, in four replicates, with
/// random numbers that no render uses. They compare relMSE, without the worst pixels, times the number of
/// rays.
///
/// A larger number must improve this cost by 2 %. The search ends at the first number that is worse by 2 %,
/// or when `pilot_ray_budget` is spent. Films of fewer than 8192 pixels and plans without path tracing do not
/// split. The result depends on the plan alone, not on `threads`, which is at least 1.
void choose_path_splitting(Plan& plan, int threads);

}  // namespace abbe

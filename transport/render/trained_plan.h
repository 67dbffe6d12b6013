#pragma once

#include <memory>

#include "transport/plan/plan.h"

namespace abbe {

/// Plan of a scene with trained guiding data. If photons accompany camera paths, pilots train
/// - where photons are emitted;
/// - the distribution of their wavelengths.
///
/// Pilots also train where camera paths look for caustics. The guiding data depend on the scene alone, not on
/// its seed, its samples or `threads`. If `guides` is not null, the plan takes that data instead, which must
/// have been trained for the same scene. The scene must outlive the plan. Throws as `make_plan`.
[[nodiscard]] Plan make_trained_plan(const Scene& scene, int threads,
                                     const std::shared_ptr<const GuidingData>& guides = {});

}  // namespace abbe

#pragma once

#include <cstdint>

#include "transport/plan/plan.h"

namespace abbe {

/// The plan of a scene whose photons, where there are any, are aimed by what pilots show to reach the film,
/// and whose camera paths look for caustics where others show them (`learn_caustics`): photons that depend on
/// the scene and `seed` alone, on that many threads, which change nothing but the time it takes. Throws what
/// `make_plan` throws.
[[nodiscard]] Plan make_learnt_plan(const Scene& scene, int threads, std::uint64_t seed);

}  // namespace abbe

#pragma once

#include <cstdint>

#include "transport/plan/plan.h"

namespace abbe {

/// Teaches a plan that traces paths where to look for caustics, by photons that depend on the scene and
/// `seed` alone, on that many threads, which change nothing but the time it takes.
void learn_caustics(Plan& plan, std::uint64_t seed, int threads);

}  // namespace abbe

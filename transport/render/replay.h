#pragma once

#include "transport/plan/plan.h"

namespace abbe {

/// Time that Embree alone takes for a render's rays, divided by the time to trace their paths. Some paths are
/// traced with their rays logged: path and light tracing as in the plan, bidirectional paths for all other
/// techniques. Then the rays are replayed. Each time is CPU time of the calling thread, the shortest of
/// three.
[[nodiscard]] double measure_replay_fraction(const Plan& plan);

/// CPU time of this thread [s].
[[nodiscard]] double thread_cpu_seconds();
/// CPU time of the whole process [s].
[[nodiscard]] double process_cpu_seconds();

}  // namespace abbe

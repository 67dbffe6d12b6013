#pragma once

#include "transport/plan/plan.h"

namespace abbe {

/// Time of a render's rays through Embree alone over the time to trace their paths: some paths, of path and
/// light tracing as the plan has them and bidirectional ones for all other techniques, are traced with their
/// rays logged, and those rays replayed; each is timed on this thread, the best of three.
[[nodiscard]] double measure_replay_share(const Plan& plan);

/// CPU time of this thread or of the whole process [s].
[[nodiscard]] double thread_cpu_seconds();
[[nodiscard]] double process_cpu_seconds();

}  // namespace abbe

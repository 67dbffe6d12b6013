#pragma once

#include <chrono>
#include <functional>
#include <utility>

namespace abbe {

/// CPU time of this thread [s].
[[nodiscard]] double thread_cpu_seconds();
/// CPU time of the whole process [s].
[[nodiscard]] double process_cpu_seconds();

/// Wall-clock time and CPU time of all threads that some work took.
struct Cost {
  double wall_s = 0;
  double cpu_s = 0;
};

/// Measures the wall-clock time, and the CPU time of all threads of the process, since its construction.
class CostMeter {
 public:
  /// Time since the construction.
  [[nodiscard]] Cost spent() const {
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start_).count(),
            process_cpu_seconds() - cpu_start_};
  }

 private:
  std::chrono::steady_clock::time_point wall_start_ = std::chrono::steady_clock::now();
  double cpu_start_ = process_cpu_seconds();
};

/// Returns a function that runs `work` and adds its cost to `sum`, which must outlive the function. If `work`
/// throws, nothing is added. Calls must not be concurrent.
[[nodiscard]] inline std::function<void()> metered(Cost& sum, std::function<void()> work) {
  return [&sum, work = std::move(work)] {
    const CostMeter meter;
    work();
    const Cost cost = meter.spent();
    sum.wall_s += cost.wall_s;
    sum.cpu_s += cost.cpu_s;
  };
}

}  // namespace abbe

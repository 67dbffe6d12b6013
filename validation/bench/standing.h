#pragma once

#include <span>
#include <vector>

#include "validation/bench/run.h"

namespace abbe {

/// What a suite's error costs by one integrator.
struct Standing {
  BenchIntegrator by;
  double cost;  ///< CPU time times relMSE, both as means over the seeds at the most samples: as
                ///< relMSE falls with the inverse of time, the time to an error is in proportion to it.
  double cost_trimmed;  ///< The same of `rel_mse_trimmed`.

  /// Whether it is a single technique that converges to all of the suite's light: others show how they fare,
  /// and are nobody's measure.
  [[nodiscard]] bool counts() const;
};

/// Those of a run's integrators, in their order.
[[nodiscard]] std::vector<Standing> standings(const SuiteRun& run);

/// The one of those that count with the least cost of that kind; none where none counts, or where the
/// reference's noise hides what they err by.
[[nodiscard]] const Standing* best_single(std::span<const Standing> all, double Standing::*cost);

}  // namespace abbe

#pragma once

#include <span>
#include <vector>

#include "validation/bench/run.h"

namespace abbe {

/// Cost of one integrator on a suite.
struct RankingEntry {
  BenchIntegrator by;
  /// CPU time times relMSE, both means over the seeds at the largest sample count. relMSE is inversely
  /// proportional to time, so the cost is proportional to the time that a given error takes.
  double cost;
  double cost_trimmed;  ///< Cost with `rel_mse_trimmed` instead of relMSE.

  /// True for a single unbiased integrator that can sample all light paths of the suite. Only such
  /// integrators can be the best of a ranking.
  [[nodiscard]] bool is_eligible() const;
};

/// Costs of a run's integrators, in the order of the run.
[[nodiscard]] std::vector<RankingEntry> ranking(const SuiteRun& run);

/// Eligible integrator with the smallest positive cost of the given kind. Null if there is none. A cost is
/// not positive if the noise of the reference hides the error.
[[nodiscard]] const RankingEntry* best_single(std::span<const RankingEntry> all, double RankingEntry::*cost);

}  // namespace abbe

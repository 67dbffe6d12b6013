#pragma once

#include <span>
#include <vector>

#include "validation/bench/run.h"

namespace abbe {

/// Cost of one integrator on a suite.
struct RankingEntry {
  BenchIntegrator by;
  /// CPU time [s] times relMSE, both means over the seeds at the last sample count of the run. relMSE is
  /// inversely proportional to time, so the cost is proportional to the time that a given error takes. Not
  /// positive if noise hides the error.
  double cost;
  double cost_trimmed;  ///< Cost with `rel_mse_trimmed` instead of relMSE.

  /// True for an unbiased integrator other than `automatic` that can sample all light paths of the suite.
  /// Only such integrators can be the best of a ranking.
  [[nodiscard]] bool is_eligible() const;
};

/// Costs of a run's integrators, in the order of the run; integrators without rows are omitted.
[[nodiscard]] std::vector<RankingEntry> ranking(const SuiteRun& run);

/// Eligible entry of `all` with the smallest positive cost. `cost` selects `RankingEntry::cost` or
/// `RankingEntry::cost_trimmed`. Null if there is none.
[[nodiscard]] const RankingEntry* best_single(std::span<const RankingEntry> all, double RankingEntry::*cost);

}  // namespace abbe

#include "validation/bench/ranking.h"

namespace abbe {

bool RankingEntry::is_eligible() const {
  return by.integrator != Integrator::automatic && by.unsampled.empty() && by.bias.empty();
}

std::vector<RankingEntry> ranking(const SuiteRun& run) {
  std::vector<RankingEntry> all;
  for (const BenchIntegrator& by : run.integrators) {
    const std::vector<BenchRow> means = means_over_seeds(rows_of(run.rows, by.integrator));
    if (means.empty()) continue;
    const BenchRow& last = means.back();
    all.push_back({by, last.cpu_s * last.rel_mse, last.cpu_s * last.rel_mse_trimmed});
  }
  return all;
}

const RankingEntry* best_single(std::span<const RankingEntry> all, double RankingEntry::*cost) {
  const RankingEntry* best = nullptr;
  for (const RankingEntry& one : all)
    if (one.is_eligible() && one.*cost > 0 && (best == nullptr || one.*cost < best->*cost)) best = &one;
  return best;
}

}  // namespace abbe

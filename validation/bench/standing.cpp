#include "validation/bench/standing.h"

namespace abbe {

bool Standing::counts() const {
  return by.integrator != Integrator::automatic && by.unreached.empty() && by.bias.empty();
}

std::vector<Standing> standings(const SuiteRun& run) {
  std::vector<Standing> all;
  for (const BenchIntegrator& by : run.integrators) {
    const std::vector<BenchRow> means = means_over_seeds(rows_of(run.rows, by.integrator));
    if (means.empty()) continue;
    const BenchRow& most = means.back();
    all.push_back({by, most.cpu_s * most.rel_mse, most.cpu_s * most.rel_mse_trimmed});
  }
  return all;
}

const Standing* best_single(std::span<const Standing> all, double Standing::*cost) {
  const Standing* best = nullptr;
  for (const Standing& one : all)
    if (one.counts() && one.*cost > 0 && (best == nullptr || one.*cost < best->*cost)) best = &one;
  return best;
}

}  // namespace abbe

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "validation/bench/run.h"

namespace abbe {

/// What a stored run keeps of one render.
struct BaselineRow {
  std::string suite;
  std::string integrator;  ///< Its word.
  int samples;
  std::uint64_t seed;
  double cpu_s;
  double paths;
  double rel_mse;
};

/// The rows of a `bench.json`, by `auto` where they tell no integrator. What is wrong with it is reported as
/// input errors.
[[nodiscard]] std::optional<std::vector<BaselineRow>> load_baseline(const std::filesystem::path& path,
                                                                    Diagnostics& diagnostics);

[[nodiscard]] std::vector<BaselineRow> baseline_rows(std::span<const SuiteRun> runs);

/// New over old, as the geometric mean over the renders that both runs did.
struct Ratio {
  double value;
  double noise;  ///< Half width of its 99 % interval, relative: Student's t times the standard error of the
                 ///< mean logarithm, from the scatter over sample counts and seeds. Infinite for one pair.
  /// Whether the ratio differs from 1 by more than its noise, and by more than 2 %.
  [[nodiscard]] bool changed() const;
};

/// One suite by one integrator, then and now.
struct Change {
  std::string suite;
  std::string integrator;
  std::size_t pairs;
  Ratio cpu_per_path;
  Ratio rel_mse;
};

/// Pairs renders of the same suite, integrator, sample count and seed. Suites without a pair are left out.
/// The noise is that of the renders within each run; what slows a whole run, such as another machine, is not
/// in it.
[[nodiscard]] std::vector<Change> compare_runs(std::span<const BaselineRow> before,
                                               std::span<const BaselineRow> after);

}  // namespace abbe

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

/// One render of a stored run.
struct BaselineRow {
  std::string suite;
  std::string integrator;  ///< Name of the integrator, one of `kIntegratorNames`.
  int samples;
  std::uint64_t seed;
  double cpu_s;
  double paths;
  double rel_mse;
};

/// One suite of a stored run.
struct BaselineSuite {
  std::string name;
  BenchConditions conditions;
  SourcePosition where;
};

/// A stored run, read from a `bench.json`.
struct Baseline {
  std::vector<BaselineSuite> suites;
  std::vector<BaselineRow> rows;  ///< Rows of all suites.
};

/// Reads the run of a `bench.json`. A row without an integrator was rendered by `auto`. Faults of the file
/// are reported as input errors; the result is empty then.
[[nodiscard]] std::optional<Baseline> load_baseline(const std::filesystem::path& path,
                                                    Diagnostics& diagnostics);

/// Reports an input error if the suite was measured under conditions that differ from `now`, and names each
/// difference.
void require_comparable(const BaselineSuite& then, const BenchConditions& now, Diagnostics& diagnostics);

[[nodiscard]] std::vector<BaselineRow> baseline_rows(std::span<const SuiteRun> runs);

/// Ratio of the new to the old value: the geometric mean over the renders that both runs contain.
struct Ratio {
  double value;
  /// Relative half width of the 99 % interval: exp(t s) - 1, with Student's t and the standard error s of the
  /// mean logarithm. The scatter over sample counts and seeds gives s. Infinite for a single pair.
  double noise;

  /// Ends of the interval: value/(1 + noise) and value (1 + noise).
  [[nodiscard]] double low() const { return value / (1 + noise); }
  [[nodiscard]] double high() const { return value * (1 + noise); }
  /// True if the ratio differs from 1 by more than its noise and by more than 2 %.
  [[nodiscard]] bool changed() const;
};

/// Change of one suite, rendered by one integrator, from the old run to the new one.
struct Change {
  std::string suite;
  std::string integrator;
  std::size_t pairs;
  Ratio cpu_per_path;
  Ratio rel_mse;
};

/// Pairs the renders of equal suite, integrator, sample count and seed. Suites without a pair are omitted.
/// The noise covers the scatter of the renders within each run. It does not cover what slows a whole run,
/// such as another machine.
[[nodiscard]] std::vector<Change> compare_runs(std::span<const BaselineRow> before,
                                               std::span<const BaselineRow> after);

}  // namespace abbe

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

/// One render of a stored run, with figures as in `BenchRow`.
struct BaselineRow {
  std::string suite;
  std::string integrator;
  int samples;
  std::uint64_t seed;
  double cpu_s;
  double paths;
  double rel_mse;
};

struct BaselineSuite {
  std::string name;
  BenchConditions conditions;
  SourcePosition where;  ///< Position of the suite in its file.
};

/// A stored run, read from a `bench.json`.
struct Baseline {
  std::vector<BaselineSuite> suites;
  std::vector<BaselineRow> rows;  ///< Of all suites, in the order of the file.
};

/// Reads the run of a `bench.json`. A row without an integrator was rendered by `auto`. Faults of the file
/// are reported as errors with ErrorCode::input; the result is empty then.
[[nodiscard]] std::optional<Baseline> load_baseline(const std::filesystem::path& path,
                                                    Diagnostics& diagnostics);

/// Reports an error with ErrorCode::input that names each condition in which the suite differs from `now`.
void require_comparable(const BaselineSuite& then, const BenchConditions& now, Diagnostics& diagnostics);

/// Rows of this program's runs, in their order.
[[nodiscard]] std::vector<BaselineRow> baseline_rows(std::span<const SuiteRun> runs);

/// Ratio of the new to the old value: the geometric mean over the renders that both runs contain. It is 1
/// with infinite noise if no pair has usable values.
struct Ratio {
  double value;  ///< Above 1 if the new value is larger.
  /// Relative half width of the 99 % interval: exp(t s) - 1, with Student's t and the standard error s of the
  /// mean logarithm. The scatter over sample counts and seeds gives s. Infinite for a single pair.
  double noise;

  [[nodiscard]] double low() const { return value / (1 + noise); }
  [[nodiscard]] double high() const { return value * (1 + noise); }
  /// True if the ratio differs from 1 by more than its noise and by more than 2 %.
  [[nodiscard]] bool changed() const;
};

/// Change of one suite, rendered by one integrator, from the old run to the new one.
struct Change {
  std::string suite;
  std::string integrator;
  std::size_t pairs;   ///< Number of renders that both runs contain.
  Ratio cpu_per_path;  ///< Ratio of CPU time divided by the number of paths.
  Ratio rel_mse;       ///< Over the pairs in which both errors are positive.
};

/// Pairs the renders of equal suite, integrator, sample count and seed. The changes have the order of
/// `after`; suites and integrators without a pair are omitted.
/// The noise covers the scatter of the renders within each run. It does not cover what slows a whole run,
/// such as another machine.
[[nodiscard]] std::vector<Change> compare_runs(std::span<const BaselineRow> before,
                                               std::span<const BaselineRow> after);

}  // namespace abbe

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

/// What a stored run keeps of one suite.
struct BaselineSuite {
  std::string name;
  BenchConditions conditions;
  SourcePosition where;
};

/// A stored run.
struct Baseline {
  std::vector<BaselineSuite> suites;
  std::vector<BaselineRow> rows;  ///< Of all suites.
};

/// The run of a `bench.json`, its rows by `auto` where they tell no integrator. What is wrong with it is
/// reported as input errors.
[[nodiscard]] std::optional<Baseline> load_baseline(const std::filesystem::path& path,
                                                    Diagnostics& diagnostics);

/// Reports as an input error a suite that was measured under other conditions than `now`, and in which they
/// differ.
void require_comparable(const BaselineSuite& then, const BenchConditions& now, Diagnostics& diagnostics);

[[nodiscard]] std::vector<BaselineRow> baseline_rows(std::span<const SuiteRun> runs);

/// New over old, as the geometric mean over the renders that both runs did.
struct Ratio {
  double value;
  /// How far its 99 % interval goes, as a factor less 1: exp(t s) - 1, t Student's, s the standard error of
  /// the mean logarithm, from the scatter over sample counts and seeds. Infinite for one pair.
  double noise;

  /// The ends of that interval: `value` over 1 + `noise`, and times it.
  [[nodiscard]] double low() const { return value / (1 + noise); }
  [[nodiscard]] double high() const { return value * (1 + noise); }
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

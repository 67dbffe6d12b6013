#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "validation/bench/run.h"
#include "validation/cases/case.h"

namespace abbe::cli {

/// Options of `abbe bench`. `cache` may be empty for `$XDG_CACHE_HOME/abbe/bench` or else
/// `~/.cache/abbe/bench`; `bench` sets `version` and `say`.
struct BenchOptions : BenchSettings {
  std::vector<std::string> suites;  ///< Names of suites, as `list` prints them; empty for all.
  /// Folder of the report; empty for none. For a soak test it is the folder of the failures, and empty for
  /// `<cache>/soak`.
  std::filesystem::path output;
  std::filesystem::path baseline;  ///< File bench.json of an earlier run; empty for none.
  bool strict = false;             ///< Exit with 1 if a figure became worse than the baseline.
  bool list = false;               ///< List the suites instead.
  bool scale = false;              ///< Measure the cost of scenes of growing size instead.
  std::uint64_t soak_paths = 0;    ///< If not 0, run a soak test with this number of paths instead.
  std::uint64_t soak_seed = 0;     ///< Seed of the first random scene.
  bool json = false;               ///< Print the answer as JSON instead of plain text.
};

/// Numbers of samples per pixel, 1 to 2^20, from a list such as "4,8,16", in ascending order without
/// duplicates. Throws Error{usage} that names the option for another text.
[[nodiscard]] std::vector<int> parse_sample_counts(const std::string& option, const std::string& text);

/// Integrators from a list such as "auto,path", in the order of `kIntegratorNames` without duplicates. Throws
/// Error{usage} that names the option for an unknown name.
[[nodiscard]] std::vector<Integrator> parse_integrators(const std::string& option, const std::string& text);

/// Renders the suites, compares them with their references and with the baseline, and prints times and
/// errors. The options `list`, `scale` and `soak_paths` replace this, in this order of precedence. Returns 0.
/// Returns 1 if `strict` is set and a figure became worse, or if the soak test failed.
/// Throws Error{usage}
/// - for unknown suites;
/// - if `cache` is empty and neither XDG_CACHE_HOME nor HOME is set;
/// - for a soak test with both `output` and `cache`;
/// - if a file of the report is the same as `baseline` or a table of the data directory.
///
/// Throws InvalidInput for a baseline that cannot be read or compared, Error{output} if the report or the
/// failures cannot be written.
int bench(const BenchOptions& options);

/// Options of `abbe validate`.
struct ValidateOptions {
  std::vector<Suite> suites;     ///< Suites to run; empty for all.
  bool quick = false;            ///< Use wider tolerances for films, which takes less than two minutes.
  std::filesystem::path output;  ///< Folder for `report.html` and `report.json`; empty for neither.
  int threads = 0;               ///< Number of threads; 0 for one per processor.
  bool json = false;             ///< Print the answer as JSON instead of plain text.
};

/// Suites of a list of names such as "optics,colour", in its order. Throws Error{usage} that names `option`
/// for an unknown name.
[[nodiscard]] std::vector<Suite> parse_suites(const std::string& option, const std::string& text);

/// Computes the cases with known answers and prints the results. Returns 0, or 1 if a case failed. Throws
/// Error{output} if the report cannot be written.
int validate(const ValidateOptions& options);

}  // namespace abbe::cli

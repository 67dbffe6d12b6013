#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace abbe::cli {

/// Options of `abbe bench`.
struct BenchOptions {
  std::vector<std::string> suites;  ///< Names of suites; empty for all.
  std::filesystem::path output;     ///< Folder of the report; empty for none.
  std::vector<Integrator> integrators{Integrator::automatic};
  std::vector<int> samples{4, 8, 16, 32, 64};
  int seeds = 3;    ///< Renders with different seeds per suite, integrator and number of samples.
  int threads = 0;  ///< Number of threads; 0 for one per processor.
  /// Samples per pixel of the reference; 0 for 64 times the largest of `samples`.
  int reference_samples = 0;
  std::filesystem::path baseline;  ///< File bench.json of an earlier run; empty for none.
  /// Folder for references and generated meshes; empty for `$XDG_CACHE_HOME/abbe/bench` or else
  /// `~/.cache/abbe/bench`.
  std::filesystem::path cache;
  bool quick = false;            ///< Use small films without comparison with other renderers.
  bool strict = false;           ///< Exit with 1 if a figure became worse than the baseline.
  bool list = false;             ///< List the suites instead.
  bool scale = false;            ///< Measure the cost of scenes of growing size instead.
  std::uint64_t soak_paths = 0;  ///< If not 0, run a soak test with this number of paths instead.
  std::uint64_t soak_seed = 0;   ///< Seed of the first random scene.
  bool json = false;
};

/// Numbers of samples per pixel from a list such as "4,8,16", in ascending order without duplicates. Throws
/// Error{usage} that names the option.
[[nodiscard]] std::vector<int> parse_sample_counts(const std::string& option, const std::string& text);

/// Integrators from a list such as "auto,path", in the order of `kIntegratorNames` without duplicates. Throws
/// Error{usage} that names the option.
[[nodiscard]] std::vector<Integrator> parse_integrators(const std::string& option, const std::string& text);

/// Renders the suites, compares them with their references and prints times and errors. Returns the exit
/// code.
int bench(const BenchOptions& options);

}  // namespace abbe::cli

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "description/load.h"

namespace abbe {

/// A scene that is rendered against the clock.
struct BenchSuite {
  std::string name;  ///< Name as in `data/bench/rivals.csv`.
  std::string description;
  std::string scene;                    ///< Path of the scene relative to the data directory.
  std::vector<Override> settings = {};  ///< Overrides applied to the scene.
  /// Writes the meshes that the scene names to the folder of its copy; null for a scene without generated
  /// meshes.
  void (*make_meshes)(const std::filesystem::path& folder) = nullptr;
};

/// All suites, in the order in which they run.
[[nodiscard]] const std::vector<BenchSuite>& bench_suites();

/// Rooms of high albedo with a smooth ball, whose paths are long. The name `bright-rooms` selects all of
/// them. They run only if they are named.
[[nodiscard]] const std::vector<BenchSuite>& bright_rooms();

/// Suites of the given names in their order, each once; `bench_suites` if no name is given. Throws
/// Error{usage} for an unknown name.
[[nodiscard]] std::vector<BenchSuite> choose_suites(const std::vector<std::string>& names);

/// Loads the scene of a suite after writing the meshes it needs to a folder of `cache`. With `quick` the
/// edges of the film are divided by four. Throws Error{input} with the loader's diagnostics.
[[nodiscard]] Scene load_suite(const BenchSuite& suite, const std::filesystem::path& cache, bool quick);

}  // namespace abbe

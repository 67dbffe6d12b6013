#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "description/load.h"

namespace abbe {

/// A scene that is rendered against the clock.
struct BenchSuite {
  std::string name;  ///< As in `data/bench/rivals.csv`.
  std::string description;
  std::string scene;                    ///< Relative to the data directory.
  std::vector<Override> settings = {};  ///< Applied to the scene.
  /// Writes the meshes that the scene names into the folder it is to be copied to; null without any.
  void (*make_meshes)(const std::filesystem::path& folder) = nullptr;
};

/// All suites, in the order they run.
[[nodiscard]] const std::vector<BenchSuite>& bench_suites();

/// Rooms of high albedo with a smooth ball, whose paths are deep: by the name `bright-rooms` all, or each by
/// its own. They run only where they are named.
[[nodiscard]] const std::vector<BenchSuite>& bright_rooms();

/// The suites of those names in their order, each once; `bench_suites` for none. Throws Error{usage} for
/// another name.
[[nodiscard]] std::vector<BenchSuite> choose_suites(const std::vector<std::string>& names);

/// The scene of a suite, any mesh it needs written to a folder of `cache` first; with `quick` a film of a
/// quarter of the edges. Throws Error{input} with the loader's complaints.
[[nodiscard]] Scene load_suite(const BenchSuite& suite, const std::filesystem::path& cache, bool quick);

}  // namespace abbe

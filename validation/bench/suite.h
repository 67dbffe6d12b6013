#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "description/load.h"

namespace abbe {

/// A scene that is rendered against the clock.
struct BenchSuite {
  std::string name;  ///< Name on the command line, in reports and in `data/bench/rivals.csv`.
  std::string description;
  std::string scene;  ///< Path relative to the data directory.
  std::vector<Override> settings = {};
  /// Writes the meshes that the scene names to the folder of its copy, and throws Error{output} if it cannot.
  /// Null for a scene without generated meshes.
  void (*make_meshes)(const std::filesystem::path& folder) = nullptr;
};

/// All suites except `bright_rooms`, in the order in which they run.
[[nodiscard]] const std::vector<BenchSuite>& bench_suites();

/// Rooms of albedo 0.5 to 0.95 around a smooth ball, closed or open on two sides, in which light paths are
/// long. They run only if they are named.
[[nodiscard]] const std::vector<BenchSuite>& bright_rooms();

/// Suites in the order of the given names, each once; `bench_suites` if no name is given. `bright-rooms`
/// selects all of `bright_rooms`. Throws Error{usage} for an unknown name.
[[nodiscard]] std::vector<BenchSuite> choose_suites(const std::vector<std::string>& names);

/// Loads the scene of a suite after writing the meshes it needs, with a copy of its file, to a folder of
/// `cache`. `quick` divides the edges of the film by four, rounded down but at least 1 px, and multiplies the
/// pixel pitch by four. Throws Error{input} with the loader's diagnostics, and Error{output} if a mesh cannot
/// be written.
[[nodiscard]] Scene load_suite(const BenchSuite& suite, const std::filesystem::path& cache, bool quick);

}  // namespace abbe

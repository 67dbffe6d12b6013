#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace abbe::cli {

/// What `abbe bench` was asked for.
struct BenchOptions {
  std::vector<std::string> suites;  ///< All when empty.
  std::filesystem::path output;     ///< Folder for the report; nothing is written when empty.
  std::vector<Integrator> integrators{Integrator::automatic};
  std::vector<int> samples{4, 8, 16, 32, 64};
  int seeds = 3;
  int threads = 0;
  int reference_samples = 0;  ///< 0: 64 times the largest of `samples`.
  std::filesystem::path baseline;
  std::filesystem::path cache;  ///< Empty: `$XDG_CACHE_HOME/abbe/bench`, else `~/.cache/abbe/bench`.
  bool quick = false;           ///< Small films, compared with no rival.
  bool strict = false;          ///< Exit with 1 when something got worse than the baseline.
  bool list = false;
  bool scale = false;            ///< Measure instead what scenes of growing size cost.
  std::uint64_t soak_paths = 0;  ///< Not 0: look instead whether anything goes wrong in drawn scenes.
  std::uint64_t soak_seed = 0;
  bool json = false;
};

/// Numbers of samples per pixel, ascending, from "4,8,16". Throws Error{usage} naming the option.
[[nodiscard]] std::vector<int> parse_sample_counts(const std::string& option, const std::string& text);

/// Integrators in the order of their list, from "auto,path". Throws Error{usage} naming the option.
[[nodiscard]] std::vector<Integrator> parse_integrators(const std::string& option, const std::string& text);

/// Renders the suites against the clock and their references, and prints the figures. Returns the exit code.
int bench(const BenchOptions& options);

}  // namespace abbe::cli

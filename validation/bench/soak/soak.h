#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace abbe {

struct SoakSettings {
  std::uint64_t paths;           ///< The test ends when this number of paths has been traced.
  std::uint64_t seed;            ///< Seed of the first scene; each further scene adds 1.
  std::filesystem::path folder;  ///< Parent of one folder `soak_<seed>` per scene.
  /// Called with each failure and, after every 100 scenes, with the progress. Must be set.
  std::function<void(const std::string&)> say;
};

struct SoakResult {
  std::uint64_t scenes = 0;  ///< Scenes drawn, with those that failed.
  std::uint64_t paths = 0;   ///< Paths of the first render of each scene.
  std::uint64_t rays = 0;
  std::uint64_t failures = 0;
};

/// Draws scenes from the whole scene language and checks each in a process of its own, until `paths` paths
/// have been traced or 100 scenes have failed. Crashes and scenes that take more than ten minutes of CPU time
/// count as failures. Retains the folders of failed scenes only. Must be called before any thread starts,
/// because it forks. Throws Error{resource} if no process can be started, and
/// std::filesystem::filesystem_error if a folder cannot be created.
[[nodiscard]] SoakResult run_soak(const SoakSettings& settings);

}  // namespace abbe

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace abbe {

/// Settings of a soak test.
struct SoakSettings {
  std::uint64_t paths;           ///< Scenes are drawn until this number of paths has been traced.
  std::uint64_t seed;            ///< Seed of the first scene; each further scene adds 1.
  std::filesystem::path folder;  ///< Folder for failed scenes and their files.
  std::function<void(const std::string&)> say;  ///< Called with each failure and regularly with the progress.
};

/// Totals of a soak test.
struct SoakResult {
  std::uint64_t scenes = 0;
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;
  std::uint64_t failures = 0;
};

/// Draws scenes from the whole scene language and checks each in a process of its own. Crashes and scenes
/// that take more than ten minutes of CPU time count as failures. Must be called before any thread starts.
/// Throws Error{output}.
[[nodiscard]] SoakResult run_soak(const SoakSettings& settings);

}  // namespace abbe

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace abbe {

/// How long to soak, and in what.
struct SoakSettings {
  std::uint64_t paths;                          ///< Scenes are drawn until so many have been traced.
  std::uint64_t seed;                           ///< Of the first scene; the next ones count on from it.
  std::filesystem::path folder;                 ///< Where scenes that fail are kept, with their files.
  std::function<void(const std::string&)> say;  ///< Told of each failure, and now and then how far it is.
};

/// What a soak found.
struct SoakResult {
  std::uint64_t scenes = 0;
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;
  std::uint64_t failures = 0;
};

/// Draws scenes from the whole language and looks whether anything goes wrong with them, each in a process of
/// its own: a crash, or a scene that takes more than ten minutes of CPU time, is a failure like others. Must
/// be called before anything has started threads. Throws Error{output}.
[[nodiscard]] SoakResult run_soak(const SoakSettings& settings);

}  // namespace abbe

#pragma once

#include <filesystem>
#include <string>

namespace abbe {

/// The path that stands for standard input where a command reads, for standard output where it writes.
inline constexpr const char* kStandardStream = "-";

/// What messages call standard input.
inline constexpr const char* kStandardInputName = "<stdin>";

/// What messages call a path that is read.
[[nodiscard]] inline std::string input_name(const std::filesystem::path& path) {
  return path == kStandardStream ? kStandardInputName : path.string();
}

}  // namespace abbe

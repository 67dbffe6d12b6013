#pragma once

#include <filesystem>
#include <string>

namespace abbe {

/// The path that means standard input for reading and standard output for writing.
inline constexpr const char* kStandardStream = "-";

/// Name of standard input in messages.
inline constexpr const char* kStandardInputName = "<stdin>";

/// Name in messages of a path that is read.
[[nodiscard]] inline std::string input_name(const std::filesystem::path& path) {
  return path == kStandardStream ? kStandardInputName : path.string();
}

}  // namespace abbe

#pragma once

#include <filesystem>
#include <vector>

#include "io/inputs.h"

namespace abbe::cli {

/// What `abbe merge` was asked for.
struct MergeOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path output;  ///< A film `.exr`, or a part again `.abbepart`.
  std::size_t max_memory_bytes = default_memory_limit();
};

/// Adds up parts of one render and writes their film. Returns the exit code.
int merge(const MergeOptions& options);

}  // namespace abbe::cli

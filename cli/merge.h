#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/inputs.h"
#include "sensor/film/crop.h"

namespace abbe::cli {

/// What `abbe merge` was asked for.
struct MergeOptions {
  std::vector<std::filesystem::path> parts;
  std::vector<std::filesystem::path> outputs;  ///< Films `.exr`, and parts again `.abbepart`.
  std::optional<Crop> crop;                    ///< Which pixels there are to be; all when absent.
  std::filesystem::path display;               ///< Picture of the film; empty when none is wanted.
  bool partial = false;                        ///< Whether samples may be missing of those that were stated.
  std::size_t max_memory_bytes = default_memory_limit();
};

/// Adds up parts of one render, ranges of samples and crops, and writes their film. Whatever their number, no
/// more memory is taken than three films need: their sum, and what a part is read into and from. Returns the
/// exit code.
int merge(const MergeOptions& options);

}  // namespace abbe::cli

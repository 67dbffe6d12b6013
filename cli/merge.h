#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/inputs.h"
#include "sensor/film/crop.h"

namespace abbe::cli {

/// Options of `abbe merge`.
struct MergeOptions {
  std::vector<std::filesystem::path> parts;
  std::vector<std::filesystem::path> outputs;  ///< Films `.exr` and partial films `.abbepart`.
  std::optional<Crop> crop;                    ///< Pixels that must be present; all without a crop.
  std::filesystem::path display;               ///< Display picture of the film; empty for none.
  bool partial = false;                        ///< Accept missing samples of those that the parts declare.
  std::size_t max_memory_bytes = default_memory_limit();
};

/// Adds parts of one render, which are ranges of samples and crops, and writes their film. The memory is that
/// of three films for any number of parts. Returns the exit code.
int merge(const MergeOptions& options);

}  // namespace abbe::cli

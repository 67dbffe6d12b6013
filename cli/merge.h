#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/inputs.h"
#include "sensor/film/crop.h"

namespace abbe::cli {

/// Options of `abbe merge`.
struct MergeOptions {
  /// Partial films `.abbepart` of one render, in any order; at least one.
  std::vector<std::filesystem::path> parts;
  /// Films `.exr` and partial films `.abbepart`; at least one.
  std::vector<std::filesystem::path> outputs;
  /// Pixels that must be present, and no others; all of the film without a crop.
  std::optional<Crop> crop;
  std::filesystem::path display;  ///< Display picture of the film; empty for none.
  bool partial = false;           ///< Accept missing samples of those that the parts declare.
  std::size_t max_memory_bytes = default_memory_limit();
};

/// Adds parts of one render, which are ranges of samples and crops, and writes their film. The memory is that
/// of three films for any number of parts. Returns 0. Throws Error{input} if parts cannot be read, do not
/// belong together or overlap, and if samples are missing without `partial`. Throws Error{usage} for outputs
/// of another extension, Error{output} if one cannot be written.
int merge(const MergeOptions& options);

}  // namespace abbe::cli

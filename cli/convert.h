#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "description/load.h"
#include "io/inputs.h"
#include "io/standard_stream.h"

namespace abbe::cli {

/// Options of `abbe convert`.
struct ConvertOptions {
  std::filesystem::path scene;  ///< Scene file; "-" is standard input.
  std::filesystem::path output = kStandardStream;
  std::optional<std::filesystem::path> materials = {};  ///< Materials for a scene of another renderer.
  std::vector<Override> overrides = {};
  std::size_t max_memory_bytes = default_memory_limit();
};

/// Writes a scene file in canonical form, or a scene of another renderer (see `convert_scene`) as a scene
/// file. Returns the exit code. Throws Error{usage} if the output is in another folder than the files that
/// the scene names, and for options that do not apply to this kind of scene.
int convert(const ConvertOptions& options);

}  // namespace abbe::cli

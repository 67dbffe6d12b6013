#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "description/load.h"
#include "io/inputs.h"
#include "io/standard_stream.h"

namespace abbe::cli {

/// What `abbe convert` was asked for.
struct ConvertOptions {
  std::filesystem::path scene;  ///< "-" is standard input.
  std::filesystem::path output = kStandardStream;
  std::optional<std::filesystem::path> materials = {};  ///< For a scene of another renderer.
  std::vector<Override> overrides = {};
  std::size_t max_memory_bytes = default_memory_limit();
};

/// Writes a scene file in canonical form, or one of another renderer (see `convert_scene`) as a scene file.
/// Returns the exit code. Throws Error{usage} for an output in another folder than the files that the scene
/// names are looked for in, and for options that are not for this kind of scene.
int convert(const ConvertOptions& options);

}  // namespace abbe::cli

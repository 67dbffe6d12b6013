#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "io/diagnostics.h"
#include "scene/scene.h"

namespace abbe {

/// One `--set /pointer=value` of the command line.
struct Override {
  std::string pointer;
  std::string value;
};

/// Reads, checks and builds a scene. Everything wrong with it is reported; nothing is returned if there is an
/// error.
[[nodiscard]] std::optional<Scene> load_scene(const std::filesystem::path& path,
                                              std::span<const Override> overrides, Diagnostics& diagnostics);

}  // namespace abbe

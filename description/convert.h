#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "description/load.h"

namespace abbe {

/// Rewrites a scene file in canonical form: keys in the order of the key tables, no comments, no default
/// values. The result describes the same scene. Reports the same diagnostics as `load_scene`; returns nothing
/// after an error.
[[nodiscard]] std::optional<std::string> canonical_scene(const std::filesystem::path& path,
                                                         std::span<const Override> overrides,
                                                         Diagnostics& diagnostics, Inputs* inputs = nullptr);

}  // namespace abbe

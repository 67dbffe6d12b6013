#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "description/load.h"

namespace abbe {

/// A scene file as its tables write it: keys in their order, no comments, no value that is the default of its
/// key; it makes the same scene. Reads and complains as `load_scene` does; nothing is returned if there is an
/// error.
[[nodiscard]] std::optional<std::string> canonical_scene(const std::filesystem::path& path,
                                                         std::span<const Override> overrides,
                                                         Diagnostics& diagnostics, Inputs* inputs = nullptr);

}  // namespace abbe

#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "description/load.h"

namespace abbe {

/// The text of a scene file in canonical form: keys in the order of the key tables, no comments, no default
/// values. It describes the same scene with `overrides` applied; the keys of a sensor model are written out.
/// The file is not changed. Reports the same diagnostics and throws the same errors as `load_scene`; returns
/// nothing after an error. `inputs`, if given, records the files that are read.
[[nodiscard]] std::optional<std::string> canonical_scene(const std::filesystem::path& path,
                                                         std::span<const Override> overrides,
                                                         Diagnostics& diagnostics, Inputs* inputs = nullptr);

}  // namespace abbe

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/diagnostics.h"
#include "io/inputs.h"

namespace abbe {

/// Options of `convert_scene`.
struct ConversionOptions {
  /// Folder of the scene to be written; file names in it are relative to this folder. Empty for the working
  /// directory.
  std::filesystem::path folder;
  /// JSON file of materials that replace those of the scene, by name. Nothing is replaced if absent.
  std::optional<std::filesystem::path> materials = {};
};

/// True if an importer exists for the file's extension, in either case: .pbrt (pbrt-v4), .xml (Mitsuba 3),
/// .gltf and .glb. The file need not exist.
[[nodiscard]] bool is_importable_scene(const std::filesystem::path& path);

/// Converts a scene of another renderer to a scene file of Abbe, as far as Abbe can represent it, and returns
/// its text. `path` must satisfy `is_importable_scene`; otherwise the behaviour is undefined. Approximated or
/// dropped properties are reported as warnings, and listed in comments at the start of the text. Reports all
/// errors, also of loading the result, and returns nothing if `diagnostics` then has an error. All files that
/// are read are added to `inputs`, if given. Throws Error{resource} if its memory limit is exceeded, and
/// Error{input} for an unreadable environment image.
[[nodiscard]] std::optional<std::string> convert_scene(const std::filesystem::path& path,
                                                       const ConversionOptions& conversion,
                                                       Diagnostics& diagnostics, Inputs* inputs = nullptr);

}  // namespace abbe

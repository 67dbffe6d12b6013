#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/diagnostics.h"
#include "io/inputs.h"

namespace abbe {

/// Options of `convert_scene`.
struct ConversionOptions {
  std::filesystem::path
      folder;  ///< Folder of the scene to be written; file names in it are relative to this folder.
  std::optional<std::filesystem::path> materials =
      {};  ///< JSON file of materials that replace those of the scene, by name.
};

/// True if an importer exists for the file's extension: .pbrt (pbrt-v4), .xml (Mitsuba 3), .gltf and .glb.
[[nodiscard]] bool is_importable_scene(const std::filesystem::path& path);

/// Converts a scene of another renderer to a scene file of Abbe, as far as Abbe can represent it, and returns
/// its text. What is approximated or dropped is reported as warnings, and listed in comments at its start.
/// Reports all errors and returns nothing if there is one.
[[nodiscard]] std::optional<std::string> convert_scene(const std::filesystem::path& path,
                                                       const ConversionOptions& conversion,
                                                       Diagnostics& diagnostics, Inputs* inputs = nullptr);

}  // namespace abbe

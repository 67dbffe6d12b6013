#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/diagnostics.h"
#include "io/inputs.h"

namespace abbe {

/// What `convert_scene` is told beside the file.
struct Conversion {
  std::filesystem::path folder;  ///< Of the scene to be written: the files it names are named as from there.
  std::optional<std::filesystem::path> materials = {};  ///< Of materials that replace the scene's, by name.
};

/// Whether files of that extension are scenes of another renderer: .pbrt of pbrt-v4,
/// .xml of Mitsuba 3, .gltf and .glb.
[[nodiscard]] bool is_other_scene(const std::filesystem::path& path);

/// The text of a scene that is as the one of another renderer, as far as it can be represented: what is
/// approximated or dropped is told in warnings, and in comments at its beginning. Everything wrong with it is
/// reported; nothing is returned if there is an error.
[[nodiscard]] std::optional<std::string> convert_scene(const std::filesystem::path& path,
                                                       const Conversion& conversion, Diagnostics& diagnostics,
                                                       Inputs* inputs = nullptr);

}  // namespace abbe

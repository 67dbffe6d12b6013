#pragma once

#include <filesystem>

#include "description/doors/shared/door.h"

namespace abbe::doors {

/// Reads a glTF 2.0 or GLB file into the scene of the door: the meshes, each material's as one shape of the
/// file, the first camera, and the lights of KHR_lights_punctual. Reports what is malformed or missing; notes
/// what is approximated or dropped. False if there is an error.
bool read_gltf_scene(const std::filesystem::path& file, Door& door);

}  // namespace abbe::doors

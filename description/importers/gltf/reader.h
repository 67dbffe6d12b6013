#pragma once

#include <filesystem>

#include "description/importers/shared/scene_importer.h"

namespace abbe::importers {

/// Reads a glTF 2.0 or GLB file into the importer's scene:
/// - the meshes, one shape per material;
/// - the first perspective camera or, without one, the first camera;
/// - the lights of KHR_lights_punctual.
/// Reports malformed and missing data; notes what is approximated or dropped. False if there is an error.
bool read_gltf_scene(const std::filesystem::path& file, SceneImporter& importer);

}  // namespace abbe::importers

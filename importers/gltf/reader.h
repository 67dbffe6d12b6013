#pragma once

#include <filesystem>

#include "importers/shared/scene_importer.h"

namespace abbe::importers {

/// Reads a glTF 2.0 or GLB file into `importer.scene`, in metres:
/// - the meshes of the default scene, or of the first scene, as one shape per material;
/// - the first perspective camera or, without one, the first camera;
/// - a camera that sees all meshes along -z if the file has none;
/// - the lights of KHR_lights_punctual.
/// Reports malformed and missing data to `importer.diagnostics`; notes what is approximated or dropped. False
/// if the diagnostics have an error. Throws Error{resource} if the memory limit of `importer.inputs` is
/// exceeded.
bool read_gltf_scene(const std::filesystem::path& file, SceneImporter& importer);

}  // namespace abbe::importers

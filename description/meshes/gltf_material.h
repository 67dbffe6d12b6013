#pragma once

#include <cstddef>

#include "description/meshes/mesh_formats.h"

namespace tinygltf {
struct Material;
}

namespace abbe {

/// Adds a material of a glTF file to `reading.file.materials`. Its index `number` in the file, counted from
/// 0, names it if it has no name. False after a fault: a base colour outside [0, 1], or a refractive index
/// outside (0, 100].
[[nodiscard]] bool read_gltf_material(const tinygltf::Material& from, std::size_t number,
                                      MeshReading& reading);

}  // namespace abbe

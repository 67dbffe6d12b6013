#pragma once

#include <cstddef>

#include "description/meshes/mesh_formats.h"

namespace tinygltf {
struct Material;
}

namespace abbe {

/// Adds material number `number` of a glTF file to the mesh file. False after a fault.
[[nodiscard]] bool read_gltf_material(const tinygltf::Material& from, std::size_t number,
                                      MeshReading& reading);

}  // namespace abbe

#pragma once

#include <cstddef>

#include "description/meshes/mesh_formats.h"

namespace tinygltf {
struct Material;
}

namespace abbe {

/// Adds what the material number `number` of a glTF file is to those of the mesh file; whether it is sound.
[[nodiscard]] bool read_gltf_material(const tinygltf::Material& from, std::size_t number,
                                      MeshReading& reading);

}  // namespace abbe

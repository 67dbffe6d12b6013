#pragma once

#include <string>
#include <vector>

namespace abbe {

/// Name of material number `number` of a glTF file that gives it none.
[[nodiscard]] std::string unnamed_gltf_material(std::size_t number);
/// Name of the material of primitives without a material.
inline constexpr const char* kDefaultGltfMaterial = "default";

/// Makes names distinct by appending a number to each repeated one. Materials of glTF files are identified by
/// their index, and several may have the same name.
[[nodiscard]] std::vector<std::string> distinct_names(std::vector<std::string> names);

}  // namespace abbe

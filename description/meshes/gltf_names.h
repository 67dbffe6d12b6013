#pragma once

#include <string>
#include <vector>

namespace abbe {

/// Name of a material of a glTF file that gives it none: "material N" for its index N, counted from 0.
[[nodiscard]] std::string unnamed_gltf_material(std::size_t number);
/// Name of the material of primitives without a material.
inline constexpr const char* kDefaultGltfMaterial = "default";

/// Makes names distinct, in the same order. The first of several equal names stays; the others become "NAME
/// 2", "NAME 3" and so on. Materials of glTF files are identified by their index, and several may have the
/// same name.
[[nodiscard]] std::vector<std::string> distinct_names(std::vector<std::string> names);

}  // namespace abbe

#pragma once

#include <string>
#include <vector>

namespace abbe {

/// The name of the material number `number` of a glTF file that gives it none.
[[nodiscard]] std::string unnamed_gltf_material(std::size_t number);
/// What stands for the material of a glTF file's primitives that have none.
inline constexpr const char* kDefaultGltfMaterial = "default";

/// The same names, each that came before with a number behind it: glTF files tell materials apart by their
/// place, and more than one may have a name.
[[nodiscard]] std::vector<std::string> distinct_names(std::vector<std::string> names);

}  // namespace abbe

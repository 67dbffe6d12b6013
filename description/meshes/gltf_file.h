#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace abbe {

/// Error message for bytes from which `gltf_json` returns nothing.
inline constexpr const char* kBadGlb = "malformed or truncated GLB, or one not of version 2";

/// The JSON text in the bytes of a .gltf or .glb file, as a view of `bytes`. Bytes that do not begin with
/// "glTF" are returned whole; their syntax is not checked. Nothing for a GLB that is malformed, truncated or
/// not of version 2.
[[nodiscard]] std::optional<std::string_view> gltf_json(std::string_view bytes);

/// Name of a material of a glTF file that gives it none: "material N" for its index N, counted from 0.
[[nodiscard]] std::string unnamed_gltf_material(std::size_t number);
/// Name of the material of primitives without a material.
inline constexpr const char* kDefaultGltfMaterial = "default";

/// Makes names distinct, in the same order. The first of several equal names stays; the others become "NAME
/// 2", "NAME 3" and so on. Materials of glTF files are identified by their index, and several may have the
/// same name.
[[nodiscard]] std::vector<std::string> distinct_names(std::vector<std::string> names);

}  // namespace abbe

#pragma once

#include <optional>
#include <string_view>

namespace abbe {

/// The error for bytes from which `gltf_json` returns nothing.
inline constexpr const char* kBadGlb = "malformed or truncated GLB, or one not of version 2";

/// The JSON text in the bytes of a .gltf or .glb file. Nothing for a GLB that is malformed, truncated or not
/// of version 2.
[[nodiscard]] std::optional<std::string_view> gltf_json(std::string_view bytes);

}  // namespace abbe

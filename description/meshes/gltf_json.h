#pragma once

#include <optional>
#include <string_view>

namespace abbe {

/// Error message for bytes from which `gltf_json` returns nothing.
inline constexpr const char* kBadGlb = "malformed or truncated GLB, or one not of version 2";

/// The JSON text in the bytes of a .gltf or .glb file, as a view of `bytes`. Bytes that do not begin with
/// "glTF" are returned whole; their syntax is not checked. Nothing for a GLB that is malformed, truncated or
/// not of version 2.
[[nodiscard]] std::optional<std::string_view> gltf_json(std::string_view bytes);

}  // namespace abbe

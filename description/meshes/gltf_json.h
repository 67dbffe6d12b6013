#pragma once

#include <optional>
#include <string_view>

namespace abbe {

/// What is wrong with bytes of which `gltf_json` gives nothing.
inline constexpr const char* kBadGlb = "malformed or truncated GLB, or one not of version 2";

/// The JSON of the bytes of a .gltf or .glb file; nothing for a GLB that is malformed, truncated or not of
/// version 2.
[[nodiscard]] std::optional<std::string_view> gltf_json(std::string_view bytes);

}  // namespace abbe

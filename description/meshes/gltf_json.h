#pragma once

#include <optional>
#include <string_view>

namespace abbe {

/// The JSON of the bytes of a .gltf or .glb file; nothing for a GLB that is malformed or truncated.
[[nodiscard]] std::optional<std::string_view> gltf_json(std::string_view bytes);

}  // namespace abbe

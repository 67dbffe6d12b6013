#pragma once

#include <cstdint>
#include <filesystem>

namespace abbe::soak {

/// A drawn scene and what a render of it must satisfy.
struct DrawnScene {
  std::filesystem::path path;  ///< The scene file, `soak_<seed>.json`.
  /// The camera is in a closed opaque box, and `kOutsideChannel` records only light from outside.
  bool closed;
  bool signed_response;  ///< A channel may have a negative response.
};

/// Draws a scene from the whole scene language and writes it with its files to `folder`, which must exist and
/// contain no files of another scene. Their contents depend on the seed only. Throws Error{output} if a file
/// cannot be written.
[[nodiscard]] DrawnScene draw_scene(std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace abbe::soak

#pragma once

#include <cstdint>
#include <filesystem>

namespace abbe::soak {

/// What a drawn scene promises beside being legal.
struct DrawnScene {
  std::filesystem::path path;
  bool closed;  ///< The camera is in a closed opaque box, and `kOutsideChannel` sees only what is beyond it.
  bool signed_response;  ///< A channel may count negatively.
};

/// Draws a scene from the whole language and writes it to `folder`, with the files it names: the seed alone
/// decides what they hold. Throws Error{output}.
[[nodiscard]] DrawnScene draw_scene(std::uint64_t seed, const std::filesystem::path& folder);

}  // namespace abbe::soak

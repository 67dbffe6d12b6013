#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.h"

namespace abbe {

/// The closed, opaque shape around the camera, or around all of some points of a meter, that no light stands
/// in, so that the camera sees nothing but its dark inside; nothing where there is none. A shape is closed
/// around a point when it has no open edges and a ray from there and its opposite both leave it more often
/// than they enter it, by the shape's own code in double precision. One that emits inward is lit. A shape or
/// a camera that moves is not asked about, and a light that moves may light any.
[[nodiscard]] std::optional<std::uint32_t> dark_enclosure(const Scene& scene);

}  // namespace abbe

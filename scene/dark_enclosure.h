#pragma once

#include <cstdint>
#include <optional>

#include "scene/scene.h"

namespace abbe {

/// Finds the first closed, opaque shape around the camera that is dark inside, so that the camera sees
/// nothing else. Returns its index in `Scene::shapes`; nothing if there is none. For a probe the shape must
/// enclose all `kRepresentativePoints`. A shape without open edges encloses a point if a ray from there and
/// the opposite ray both leave the shape more often than they enter. The test is in double precision. The
/// shape is dark if no light lies in it and it does not emit inward. Moving shapes and cameras are not
/// examined. A moving light counts as illuminating every shape.
[[nodiscard]] std::optional<std::uint32_t> dark_enclosure(const Scene& scene);

}  // namespace abbe

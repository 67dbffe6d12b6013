#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// Whether a light emits anything.
[[nodiscard]] bool emits(const Light& light);

/// Where lights are looked at from: a shape, or none.
struct Viewpoint {
  Imath::V3d at;
  std::optional<std::size_t> shape;
};
/// The middles of a scene's specular shapes, in order of x, so that those near a light are found without
/// asking all.
[[nodiscard]] std::vector<Viewpoint> specular_centers(const Scene& scene);
/// Here and there on the scene's meter, in the same order.
[[nodiscard]] std::vector<Viewpoint> places_of_meter(const Scene& scene);

/// Whether the light looks smaller than `limit_sr` [sr] from everywhere there but its own shape; delta lights
/// do from anywhere. A ball of radius r looks larger than the limit from nearer than r/sin, the sine being
/// that of half the limit's cone.
[[nodiscard]] bool looks_smaller(const Scene& scene, const Light& light, std::span<const Viewpoint> from,
                                 double limit_sr);

}  // namespace abbe

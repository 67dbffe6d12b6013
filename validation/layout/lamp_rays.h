#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// The light of that name. Throws Error{usage} naming `option`, with the names there are.
[[nodiscard]] const Light& light_named(const Scene& scene, const std::string& name,
                                       const std::string& option);

/// The ray in the middle of a lamp's light, in the scene's own coordinates [m]: of a spot its axis, of a
/// surface the normal at its middle, of a point the one towards the middle of what is near, of light from
/// infinity the one through that. Nothing of an environment.
[[nodiscard]] std::optional<BasicRay<double>> middle_ray(const Scene& scene, const Light& light);

/// Whether a drawing leaves a light out: one that is far from all that is near.
[[nodiscard]] bool is_left_out(const Scene& scene, const Light& light);

/// Rays of a lamp for a drawing: `count` at least 1 in each of two planes through the middle ray, the first
/// of which contains the horizontal: fanned over its cone, over 60 degrees to both sides of a surface's
/// normal, over the whole circle around a point; in parallel across what is near from infinity. None of an
/// environment and of a light that is left out.
[[nodiscard]] std::vector<BasicRay<double>> lamp_rays(const Scene& scene, const Light& light, int count);

}  // namespace abbe

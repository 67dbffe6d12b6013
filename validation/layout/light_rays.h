#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// The light with this name. Throws Error{usage} that names `option` and lists the scene's lights.
[[nodiscard]] const Light& light_named(const Scene& scene, const std::string& name,
                                       const std::string& option);

/// Central ray of a light in scene coordinates [m]. It is empty for an environment light.
/// - Spot light: its axis.
/// - Area light: the normal at the center of its surface.
/// - Point light: the ray to the center of the scene's bounds.
/// - Sun or directional light: the ray through the center of the bounds.
[[nodiscard]] std::optional<BasicRay<double>> central_ray(const Scene& scene, const Light& light);

/// True if a drawing omits the light because it is distant from the scene's other objects.
[[nodiscard]] bool is_omitted(const Scene& scene, const Light& light);

/// Rays of a light for a drawing: `count` >= 1 in each of two perpendicular planes through the central ray.
/// The first plane contains the horizontal direction perpendicular to that ray.
/// - Spot light: a fan over its cone.
/// - Area light: a fan of 60 degrees to both sides of the normal.
/// - Point light: a full circle.
/// - Sun or directional light: parallel rays across the bounds.
/// The result is empty for an environment light and for an omitted light.
[[nodiscard]] std::vector<BasicRay<double>> light_rays(const Scene& scene, const Light& light, int count);

}  // namespace abbe

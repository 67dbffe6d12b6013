#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// The first light with this name. Throws Error{usage} if there is none; the message names the command line's
/// `option` and lists the scene's lights.
[[nodiscard]] const Light& light_named(const Scene& scene, const std::string& name,
                                       const std::string& option);

/// Central ray of a light in render coordinates [m] at time 0: infinite, with a unit direction away from the
/// light. It is empty for an environment light.
/// - Spot or photometric light: its axis.
/// - Area light: the outward normal at the center of its surface, from just off the surface. The center of
/// a mesh is that of its median triangle by cumulative area.
/// - Point light: the ray to the center of the scene's bounds, or along +x if the light is there.
/// - Sun or directional light: the ray through the center of the bounds, from 1.5 times their radius before
/// it.
[[nodiscard]] std::optional<BasicRay<double>> central_ray(const Scene& scene, const Light& light);

/// True if a drawing omits the light because it has a position and is distant by `Scene::is_distant`. False
/// in a scene without shapes that are not distant.
[[nodiscard]] bool is_omitted(const Scene& scene, const Light& light);

/// Rays of a light for a drawing, as `central_ray` describes them: `count` >= 1 in each of two perpendicular
/// planes through the central ray, first those of one plane. That plane contains the horizontal direction,
/// perpendicular to z and to the central ray; for a vertical ray it is x. A single ray per plane is the
/// central ray. More are spread evenly from edge to edge, and need not include the central ray.
/// - Spot light: a fan over its cone; photometric light: over its range of vertical angles.
/// - Area light: a fan of 60 degrees to both sides of the normal.
/// - Point light: a full circle.
/// - Sun or directional light: parallel rays across the bounds.
/// The result is empty for an environment light and for an omitted light.
[[nodiscard]] std::vector<BasicRay<double>> light_rays(const Scene& scene, const Light& light, int count);

}  // namespace abbe

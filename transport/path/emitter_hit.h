#pragma once

#include <limits>
#include <optional>

#include "transport/path/path_state.h"
#include "transport/path/path_vertex.h"

namespace abbe {

/// Calls `visit` with a `LightVertex` for every environment light and sun visible along the ray of a path
/// that leaves the scene. If the scene has such lights, first attenuates the path's throughput over the rest
/// of the ray, by the medium around it.
template <typename Visit>
void visit_escaped_lights(const Scene& scene, PathState& path, Visit visit) {
  if (scene.background().empty()) return;
  path.media.medium.attenuate(path.packet.throughput, std::numeric_limits<float>::infinity());
  for (const std::uint32_t light : scene.background())
    if (is_visible_along(scene.lights[light], path.ray.direction))
      visit(LightVertex{light, path.ray.direction, Imath::V3f(0), true});
}

/// Light vertex of the surface that a ray with the unit direction `direction` hits; nothing if it is no
/// light, or does not emit towards the ray's origin.
[[nodiscard]] inline std::optional<LightVertex> emitter_hit(const Scene& scene, const SurfaceHit& hit,
                                                            const Imath::V3f& direction) {
  const std::int32_t light = scene.shapes[hit.shape].light;
  if (light < 0) return std::nullopt;
  const auto index = static_cast<std::uint32_t>(light);
  if (!emits_towards(scene.lights[index], hit.normal, -direction)) return std::nullopt;
  return LightVertex{index, hit.point, hit.normal};
}

}  // namespace abbe

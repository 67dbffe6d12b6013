#pragma once

#include <limits>
#include <optional>

#include "transport/path/path_vertex.h"
#include "transport/path/walk.h"

namespace abbe {

/// Takes a path that leaves the scene through what is around it, and tells `found` of every light at infinity
/// that shows along its ray, as a `LightVertex`.
template <typename Found>
void find_background(const Scene& scene, Walk& path, Found found) {
  if (scene.background().empty()) return;
  path.around.medium.attenuate(path.packet.throughput, std::numeric_limits<float>::infinity());
  for (const std::uint32_t light : scene.background()) {
    const auto* sun = std::get_if<SunLight>(&scene.lights[light].kind);
    if (sun == nullptr || sun->shows(path.ray.direction))
      found(LightVertex{light, path.ray.direction, Imath::V3f(0), true});
  }
}

/// The light that a surface is, where a ray that has come to it along `direction` sees it shine.
[[nodiscard]] inline std::optional<LightVertex> light_met(const Scene& scene, const SurfaceHit& hit,
                                                          const Imath::V3f& direction) {
  const std::int32_t light = scene.shapes[hit.shape].light;
  if (light < 0) return std::nullopt;
  const auto index = static_cast<std::uint32_t>(light);
  if (!emits_towards(scene.lights[index], hit.normal, -direction)) return std::nullopt;
  return LightVertex{index, hit.point, hit.normal};
}

}  // namespace abbe

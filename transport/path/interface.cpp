#include "transport/path/interface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace abbe {
namespace {

const Material& material_of(const Scene& scene, std::uint32_t shape) {
  return scene.materials[scene.shapes[shape].material];
}

const RefractiveIndex* index_of(const Scene& scene, const MediumStack& inside) {
  return inside.empty() ? nullptr : interior(material_of(scene, inside.innermost()));
}

// Whether the matter that is around within `inside` is that of `shape`.
bool around(const Scene& scene, const MediumStack& inside, std::uint32_t shape) {
  return !inside.empty() && inside.entry_of(scene, shape) == inside.innermost();
}

bool same_around(const MediumStack& a, const MediumStack& b) {
  return a.empty() || b.empty() ? a.empty() && b.empty() : a.innermost() == b.innermost();
}

}  // namespace

ActingSurface acting_surface(const Scene& scene, std::span<const CrossedSurface> surfaces,
                             const MediumStack& inside) {
  const auto first_of = [&](const auto& kind) {
    return std::find_if(surfaces.begin(), surfaces.end(),
                        [&](const CrossedSurface& s) { return kind(material_of(scene, s.shape)); });
  };
  auto alone = first_of([](const Material& material) { return opaque(material); });
  if (alone == surfaces.end())
    alone = first_of([](const Material& material) { return !encloses_medium(material); });
  if (alone != surfaces.end())
    return {static_cast<std::size_t>(alone - surfaces.begin()), index_of(scene, inside), inside};

  MediumStack before = inside;
  for (const CrossedSurface& s : surfaces)
    if (!s.entering && !before.entry_of(scene, s.shape)) before.cross(scene, s.shape, true);
  MediumStack beyond = before;
  for (const CrossedSurface& s : surfaces)
    if (!s.entering) beyond.cross(scene, s.shape, false);
  // In the order of the scene, so that what is behind does not depend on rounding.
  std::array<std::uint32_t, TouchingSurfaces::kMost> entered;
  auto end = entered.begin();
  for (const CrossedSurface& s : surfaces)
    if (s.entering) *end++ = s.shape;
  std::sort(entered.begin(), end);
  for (auto shape = entered.begin(); shape != end; ++shape) beyond.cross(scene, *shape, true);
  if (same_around(before, beyond)) return {std::nullopt, nullptr, beyond};

  ActingSurface boundary{std::nullopt, nullptr, beyond};
  std::tuple<bool, int, std::uint32_t> highest;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const auto [shape, entering] = surfaces[i];
    const Material& material = material_of(scene, shape);
    const std::tuple rank(!is_boundary(material), material.priority,
                          shape);  // the interface, if there is one
    if (!around(scene, entering ? beyond : before, shape) || (boundary.acting && rank < highest)) continue;
    highest = rank;
    boundary.acting = i;
    boundary.outside = index_of(scene, entering ? before : beyond);
  }
  return boundary;
}

Interface interface_at(const Scene& scene, const Ray& ray, const SurfaceHit& first,
                       const MediumStack& inside) {
  const TouchingSurfaces met = scene.touching(ray, first);
  std::array<CrossedSurface, TouchingSurfaces::kMost> crossed;
  for (std::size_t i = 0; i < met.count; ++i)
    crossed[i] = {met.at[i].shape, met.at[i].normal.dot(ray.direction) < 0};
  const ActingSurface boundary = acting_surface(scene, {crossed.data(), met.count}, inside);
  SurfaceHit hit = met.at[boundary.acting.value_or(0)];
  for (const SurfaceHit& other : met.all())
    hit.spread = std::max(hit.spread, std::abs((other.point - hit.point).dot(hit.normal)));
  return {hit, !boundary.acting, boundary.outside, boundary.beyond};
}

}  // namespace abbe

#include "transport/path/interface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace abbe {
namespace {

// Of the shapes in a stack that by which its matter has an index: the innermost that has an interface.
std::optional<std::uint32_t> refracting(const Scene& scene, const MediumStack& inside) {
  const std::span<const std::uint32_t> shapes = inside.shapes();
  if (!scene.needs.boundaries) return shapes.empty() ? std::nullopt : std::optional(shapes.back());
  const auto found = std::find_if(shapes.rbegin(), shapes.rend(), [&](std::uint32_t shape) {
    return !is_boundary(material_of(scene, shape));
  });
  return found == shapes.rend() ? std::nullopt : std::optional(*found);
}

const RefractiveIndex* index_of(const Scene& scene, std::optional<std::uint32_t> shape) {
  return shape ? interior(material_of(scene, *shape)) : nullptr;
}

// Whether light is not refracted on its way from the matter of one shape to that of another.
bool same_index(const Scene& scene, std::optional<std::uint32_t> a, std::optional<std::uint32_t> b) {
  return a == b || (a && b && scene.shapes[*a].material == scene.shapes[*b].material);
}

}  // namespace

ActingSurface acting_surface(const Scene& scene, std::span<const CrossedSurface> surfaces,
                             const MediumStack& inside) {
  const auto first_of = [&](const auto& kind) {
    return std::find_if(surfaces.begin(), surfaces.end(),
                        [&](const CrossedSurface& s) { return kind(material_of(scene, s.shape)); });
  };
  const auto alone = [&](const auto& at, const MediumStack& beyond) {
    return ActingSurface{static_cast<std::size_t>(at - surfaces.begin()),
                         index_of(scene, refracting(scene, inside)), beyond};
  };
  const auto wall = first_of([](const Material& material) { return opaque(material); });
  if (wall != surfaces.end()) return alone(wall, inside);

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
  const std::optional<std::uint32_t> of_before = refracting(scene, before);
  const std::optional<std::uint32_t> of_beyond = refracting(scene, beyond);
  if (same_index(scene, of_before, of_beyond)) {
    const auto sheet = first_of([](const Material& material) { return !encloses_medium(material); });
    if (sheet != surfaces.end()) return alone(sheet, beyond);
  }
  if (of_before == of_beyond) return {std::nullopt, nullptr, beyond};

  ActingSurface boundary{std::nullopt, nullptr, beyond};
  std::pair<int, std::uint32_t> highest;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const auto [shape, entering] = surfaces[i];
    const std::pair rank(material_of(scene, shape).priority, shape);
    const std::optional<std::uint32_t> own = entering ? of_beyond : of_before;
    if (!own || (entering ? beyond : before).entry_of(scene, shape) != own) continue;
    if (boundary.acting && rank < highest) continue;
    highest = rank;
    boundary.acting = i;
    boundary.outside = index_of(scene, entering ? of_before : of_beyond);
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

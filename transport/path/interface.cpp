#include "transport/path/interface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace abbe {
namespace {

// Innermost shape of the stack that determines the index: the innermost one with an interface.
std::optional<std::uint32_t> refracting(const Scene& scene, const MediumStack& media) {
  const std::span<const std::uint32_t> shapes = media.shapes();
  if (!scene.features.boundaries) return shapes.empty() ? std::nullopt : std::optional(shapes.back());
  const auto found = std::find_if(shapes.rbegin(), shapes.rend(), [&](std::uint32_t shape) {
    return !is_boundary(material_of(scene, shape));
  });
  return found == shapes.rend() ? std::nullopt : std::optional(*found);
}

const RefractiveIndex* index_of(const Scene& scene, std::optional<std::uint32_t> shape) {
  return shape ? interior_index(material_of(scene, *shape)) : nullptr;
}

// True if light is not refracted on its way from the medium of one shape into that of the other.
bool same_index(const Scene& scene, std::optional<std::uint32_t> a, std::optional<std::uint32_t> b) {
  return a == b || (a && b && scene.shapes[*a].material == scene.shapes[*b].material);
}

}  // namespace

ActingSurface acting_surface(const Scene& scene, std::span<const CrossedSurface> surfaces,
                             const MediumStack& media) {
  const auto first_of = [&](const auto& kind) {
    return std::find_if(surfaces.begin(), surfaces.end(),
                        [&](const CrossedSurface& s) { return kind(material_of(scene, s.shape)); });
  };
  const auto alone = [&](const auto& at, const MediumStack& behind) {
    return ActingSurface{static_cast<std::size_t>(at - surfaces.begin()),
                         index_of(scene, refracting(scene, media)), behind};
  };
  const auto wall = first_of([](const Material& material) { return opaque(material); });
  if (wall != surfaces.end()) return alone(wall, media);

  MediumStack before = media;
  for (const CrossedSurface& s : surfaces)
    if (!s.entering && !before.entry_of(scene, s.shape)) before.cross(scene, s.shape, true);
  MediumStack behind = before;
  for (const CrossedSurface& s : surfaces)
    if (!s.entering) behind.cross(scene, s.shape, false);
  // Enters the shapes in the order of the scene, so that the result does not depend on rounding.
  std::array<std::uint32_t, CoincidentHits::kMaxHits> entered;
  auto end = entered.begin();
  for (const CrossedSurface& s : surfaces)
    if (s.entering) *end++ = s.shape;
  std::sort(entered.begin(), end);
  for (auto shape = entered.begin(); shape != end; ++shape) behind.cross(scene, *shape, true);
  const std::optional<std::uint32_t> medium_before = refracting(scene, before);
  const std::optional<std::uint32_t> medium_behind = refracting(scene, behind);
  if (same_index(scene, medium_before, medium_behind)) {
    const auto sheet = first_of([](const Material& material) { return !encloses_medium(material); });
    if (sheet != surfaces.end()) return alone(sheet, behind);
  }
  if (medium_before == medium_behind) return {std::nullopt, nullptr, behind};

  ActingSurface boundary{std::nullopt, nullptr, behind};
  std::pair<int, std::uint32_t> highest;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const auto [shape, entering] = surfaces[i];
    const std::pair rank(material_of(scene, shape).priority, shape);
    const std::optional<std::uint32_t> own = entering ? medium_behind : medium_before;
    if (!own || (entering ? behind : before).entry_of(scene, shape) != own) continue;
    if (boundary.acting && rank < highest) continue;
    highest = rank;
    boundary.acting = i;
    boundary.outside = index_of(scene, entering ? medium_before : medium_behind);
  }
  return boundary;
}

Interface interface_at(const Scene& scene, const Ray& ray, const SurfaceHit& first,
                       const MediumStack& media) {
  const CoincidentHits surfaces = scene.coincident(ray, first);
  std::array<CrossedSurface, CoincidentHits::kMaxHits> crossed;
  for (std::size_t i = 0; i < surfaces.count; ++i)
    crossed[i] = {surfaces.at[i].shape, surfaces.at[i].normal.dot(ray.direction) < 0};
  const ActingSurface boundary = acting_surface(scene, {crossed.data(), surfaces.count}, media);
  SurfaceHit hit = surfaces.at[boundary.acting.value_or(0)];
  for (const SurfaceHit& other : surfaces.all())
    hit.coincidence_radius =
        std::max(hit.coincidence_radius, std::abs((other.point - hit.point).dot(hit.normal)));
  return {hit, !boundary.acting, boundary.outside, boundary.media_behind};
}

}  // namespace abbe

#include "transport/path/vertex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "materials/bsdf/warp.h"

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

// True if light may be transmitted, so that both sides are sampled.
bool is_two_sided(const SurfaceVertex& vertex) {
  return !vertex.light_context().side;
}

// p(wi) of a local direction [1/sr].
float density(DirectionSampling directions, const SurfaceVertex& vertex, const Imath::V3f& wi) {
  const bool both = is_two_sided(vertex);
  if (!both && !(vertex.wo.z * wi.z > 0)) return 0;
  const float over_side = directions == DirectionSampling::cosine
                              ? std::abs(wi.z) * std::numbers::inv_pi_v<float>
                              : std::numbers::inv_pi_v<float> / 2;
  return both ? over_side / 2 : over_side;
}

// Samples a local direction; with two sides the first number also selects the side.
Imath::V3f draw(DirectionSampling directions, const SurfaceVertex& vertex, Imath::V2f u) {
  float side = std::copysign(1.0F, vertex.wo.z);
  if (is_two_sided(vertex)) {
    side = u.x < 0.5F ? 1.0F : -1.0F;
    u.x = 2 * u.x - (u.x < 0.5F ? 0.0F : 1.0F);
  }
  Imath::V3f wi = directions == DirectionSampling::cosine ? cosine_hemisphere(u)
                                                          : direction_at(1 - u.x, 2 * std::numbers::pi * u.y);
  wi.z *= side;
  return wi;
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

SampledSpectrum pdf_of_directions(DirectionSampling directions, const SurfaceVertex& vertex,
                                  const Imath::V3f& wi) {
  return (SampledSpectrum(1) - delta_probability(vertex.bsdf, vertex.wo)) * density(directions, vertex, wi);
}

std::optional<BsdfSample> sample_directions(DirectionSampling directions, const SurfaceVertex& vertex,
                                            const BsdfRandom& u, int hero, TransportMode mode) {
  std::optional<BsdfSample> event;
  const bool may_be_delta = delta_probability(vertex.bsdf, vertex.wo)[hero] > 0;
  if (may_be_delta) event = vertex.scatter(u, hero, mode);
  if (!scatters(vertex.bsdf) || (event && event->delta)) return event;
  const Imath::V3f wi = draw(directions, vertex, u.direction);
  const SampledSpectrum f = vertex.f(vertex.frame.to_world(wi), wi, mode);
  const SampledSpectrum drawn = pdf_of_directions(directions, vertex, wi);
  const float pdf = drawn[hero];
  if (f.is_zero() || !(pdf > 0)) return std::nullopt;
  return BsdfSample{.wi = wi,
                    .weight = f * (std::abs(wi.z) / pdf),
                    .lane_pdf = drawn * (1 / pdf),
                    .pdf = pdf,
                    .transmitted = wi.z * vertex.wo.z < 0};
}

}  // namespace abbe

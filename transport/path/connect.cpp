#include "transport/path/connect.h"

#include <cmath>
#include <variant>

#include "transport/path/dimensions.h"

namespace abbe {
namespace {

// Media into which the unit direction `w` leads from the vertex.
MediumState media_towards(const Scene& scene, const PathVertex& vertex, const Imath::V3f& w) {
  const auto* surface = std::get_if<SurfaceVertex>(&vertex.at);
  const bool crosses = surface != nullptr && surface->frame.to_local(w).z * surface->wo.z < 0;
  MediumState media;
  media.enter(scene, crosses ? vertex.media_behind : vertex.media_front, vertex.lambda_nm());
  return media;
}

// True if the vertex scatters into more than single directions, so that it can be connected.
bool is_connectible(const PathVertex& vertex) {
  const auto* surface = std::get_if<SurfaceVertex>(&vertex.at);
  return surface == nullptr || scatters(surface->bsdf);
}

}  // namespace

Ray spawn_towards(const PathVertex& vertex, const Imath::V3f& w) {
  if (const auto* surface = std::get_if<SurfaceVertex>(&vertex.at)) return surface->spawn_ray(w, vertex.time);
  const auto* light = std::get_if<LightVertex>(&vertex.at);
  if (light != nullptr && light->normal.length2() > 0)
    return spawn(light->point, light->normal, w, vertex.time);
  return ray_at(point_of(vertex), w, vertex.time);
}

Transmission transmission_along(const Scene& scene, RayCaster& caster, const PathVertex& from,
                                const PathSegment& segment) {
  return transmission(scene, caster, spawn_towards(from, segment.direction),
                      media_towards(scene, from, segment.direction), from.lambda_nm(),
                      static_cast<float>(segment.distance));
}

std::optional<Connection> connect(const Scene& scene, RayCaster& caster, const PathVertex& a,
                                  const PathVertex& b) {
  const PathSegment segment = segment_between(a, b);
  if (!(segment.distance > 0)) return std::nullopt;
  // Large and small factors alternate: lenses and pixels may be so small that the product of two such factors
  // underflows or overflows.
  SampledSpectrum f =
      a.packet.throughput * eval_towards(scene, a, segment.direction, TransportMode::radiance);
  if (f.is_zero()) return std::nullopt;
  f *= b.packet.throughput * eval_towards(scene, b, -segment.direction, TransportMode::power);
  if (f.is_zero()) return std::nullopt;
  if (!b.at_infinity()) f *= static_cast<float>(1 / (segment.distance * segment.distance));

  const Ray ray = spawn_towards(a, segment.direction);
  const BasicRay<double> straight =
      b.at_infinity() ? shadow_ray_along(ray)
                      : shadow_ray_between(ray.origin, spawn_towards(b, -segment.direction).origin, a.time);
  const auto through =
      unblocked_transmission(scene, caster, straight, ray, media_towards(scene, a, segment.direction),
                             a.lambda_nm(), static_cast<float>(segment.distance));
  if (!through) return std::nullopt;
  Connection connection{f * through->transmittance, through->pdf};
  if (a.packet.polarisation || b.packet.polarisation)
    connection.stokes =
        polarisation_towards(scene, a, segment.direction, TransportMode::radiance)
            .of(polarisation_towards(scene, b, -segment.direction, TransportMode::power), -segment.direction);
  return connection;
}

void choose_joined(std::span<const PathVertex> path, const Sampler& sampler,
                   std::vector<JoinedVertex>& joined) {
  joined.clear();
  double sum = path.size() > kAlwaysJoined ? static_cast<double>(sampler.group(kJoiningGroup)[0]) : 0;
  for (std::size_t number = 1; number <= path.size(); ++number) {
    const float probability = joining_probability(number);
    const double before = std::floor(sum);
    sum += static_cast<double>(probability);
    if (std::floor(sum) > before && is_connectible(path[number - 1]))
      joined.push_back({number, 1 / probability});
  }
}

}  // namespace abbe

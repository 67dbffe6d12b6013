#include "transport/path/connect.h"

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

}  // namespace abbe

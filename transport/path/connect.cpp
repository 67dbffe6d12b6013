#include "transport/path/connect.h"

namespace abbe {
namespace {

// What lies at the vertex towards the unit vector `w`.
Surroundings surroundings(const Scene& scene, const PathVertex& vertex, const Imath::V3f& w) {
  const auto* surface = std::get_if<SurfaceVertex>(&vertex.at);
  const bool crosses = surface != nullptr && surface->frame.to_local(w).z * surface->wo.z < 0;
  Surroundings around;
  around.enter(scene, crosses ? vertex.beyond : vertex.inside, vertex.lambda_nm());
  return around;
}

}  // namespace

Ray leave_towards(const PathVertex& vertex, const Imath::V3f& w) {
  if (const auto* surface = std::get_if<SurfaceVertex>(&vertex.at)) return surface->leave(w, vertex.time);
  const auto* light = std::get_if<LightVertex>(&vertex.at);
  if (light != nullptr && light->normal.length2() > 0)
    return spawn(light->point, light->normal, w, vertex.time);
  return ray_at(point_of(vertex), w, vertex.time);
}

Transmission transmission_along(const Scene& scene, RayCaster& caster, const PathVertex& from,
                                const Way& way) {
  return transmission(scene, caster, leave_towards(from, way.direction),
                      surroundings(scene, from, way.direction), from.lambda_nm(),
                      static_cast<float>(way.distance));
}

std::optional<Connection> connect(const Scene& scene, RayCaster& caster, const PathVertex& a,
                                  const PathVertex& b) {
  const Way way = way_from(a, b);
  if (!(way.distance > 0)) return std::nullopt;
  // Factors that are small and large by turns: lenses and pixels may be so small that floats do not hold what
  // two of a kind make.
  SampledSpectrum f = a.packet.throughput * sent_towards(scene, a, way.direction, TransportMode::radiance);
  if (f.is_zero()) return std::nullopt;
  f *= b.packet.throughput * sent_towards(scene, b, -way.direction, TransportMode::power);
  if (f.is_zero()) return std::nullopt;
  if (!b.at_infinity()) f *= static_cast<float>(1 / (way.distance * way.distance));

  const Ray ray = leave_towards(a, way.direction);
  const BasicRay<double> straight =
      b.at_infinity() ? way_along(ray)
                      : way_between(ray.origin, leave_towards(b, -way.direction).origin, a.time);
  const auto through =
      unblocked_transmission(scene, caster, straight, ray, surroundings(scene, a, way.direction),
                             a.lambda_nm(), static_cast<float>(way.distance));
  if (!through) return std::nullopt;
  Connection joint{f * through->transmittance, through->density};
  if (a.packet.polarisation || b.packet.polarisation)
    joint.seen =
        polarisation_towards(scene, a, way.direction, TransportMode::radiance)
            .of(polarisation_towards(scene, b, -way.direction, TransportMode::power), -way.direction);
  return joint;
}

}  // namespace abbe

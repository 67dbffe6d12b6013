#include "transport/path/free_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abbe {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool boundary(const Scene& scene, const SurfaceHit& hit) {
  return is_boundary(scene.materials[scene.shapes[hit.shape].material]);
}

// Multiplies the lanes by what is left over the way, and their densities by `density`; in units of the
// greatest of the new densities, so that they neither grow beyond all bounds nor vanish. Returns the unit.
float rescale(PathPacket& packet, const SampledSpectrum& passed, const SampledSpectrum& density) {
  packet.throughput *= passed;
  packet.lane_pdf *= density;
  const float greatest = packet.lane_pdf.max();
  if (!(greatest > 0)) return 1;
  packet.throughput *= 1 / greatest;
  packet.lane_pdf *= 1 / greatest;
  return 1 / greatest;
}

// e^(-s_k x) in units of the greatest lane's, and one over that.
struct Passed {
  SampledSpectrum lanes{1.0F};
  float unit = 1;
};
Passed pass(const Medium& medium, float distance) {
  float least = medium.extinction_per_m[0];
  for (int lane = 1; lane < kLanes; ++lane) least = std::min(least, medium.extinction_per_m[lane]);
  const auto depth = [distance](float extinction) { return extinction > 0 ? extinction * distance : 0; };
  return {exp_of_negative(SampledSpectrum::map(medium.extinction_per_m,
                                               [&](float extinction) { return -depth(extinction - least); })),
          std::exp(depth(least))};
}

// Through the boundaries that touch where one is met on the way of `ray`: the rest of the way.
Ray pass_boundaries(const Scene& scene, PathEnd& end, const Ray& ray, SurfaceHit hit) {
  const TouchingSurfaces met = scene.touching(ray, hit);
  MediumStack beyond = end.inside;
  for (const bool entering : {false, true})
    for (const SurfaceHit& one : met.all())
      if ((one.normal.dot(ray.direction) < 0) == entering) beyond.cross(scene, one.shape, entering);
  end.enter(scene, beyond);
  for (const SurfaceHit& one : met.all())
    hit.spread = std::max(hit.spread, std::abs((one.point - hit.point).dot(hit.normal)));
  return spawn(hit, ray.direction);
}

// Of the surfaces that touch where a boundary is met, one that is more than that: light meets it in the
// matter before the boundary.
std::optional<SurfaceHit> surface_at(const Scene& scene, const Ray& ray, const SurfaceHit& hit) {
  if (!boundary(scene, hit)) return hit;
  const TouchingSurfaces met = scene.touching(ray, hit);
  for (const SurfaceHit& one : met.all())
    if (!boundary(scene, one)) return one;
  return std::nullopt;
}

}  // namespace

FreePath propagate(const Scene& scene, RayCaster& caster, const Imath::V2f& u, PathEnd& end,
                   std::optional<SurfaceHit>& hit) {
  constexpr float kDigits = 0x1p-24F;  // of a random number
  float depth = -std::log1p(-std::min(u.x + (u.y + 0.5F * kDigits) * kDigits, 1 - kDigits));
  FreePath free_path;
  Ray ray = end.ray;
  float gone = 0;  // to its origin
  while (true) {
    const float distance = hit ? hit->t : kInfinity;
    if (end.medium.scattering == nullptr) {
      end.medium.attenuate(end.packet.throughput, end.medium.march(ray, distance, kInfinity).column);
    } else {
      const float extinction = end.medium.extinction_per_m[kHero];
      const GridStretch way =
          end.medium.march(ray, distance, extinction > 0 ? depth / extinction : kInfinity);
      const Passed passed = pass(end.medium, way.column);
      free_path.scattered = way.reached;
      if (way.reached) {
        rescale(end.packet, passed.lanes * end.medium.scattering_per_m,
                passed.lanes * end.medium.extinction_per_m);
        end.ray.origin = ray.origin + ray.direction * way.distance;
        return free_path;
      }
      free_path.density_scale *= passed.unit * rescale(end.packet, passed.lanes, passed.lanes);
      depth -= extinction > 0 ? extinction * way.column : 0;
    }
    if (!hit) return free_path;
    if (const std::optional<SurfaceHit> surface = surface_at(scene, ray, *hit)) {
      hit = surface;
      hit->t += gone;
      return free_path;
    }
    gone += hit->t;
    ray = pass_boundaries(scene, end, ray, *hit);
    hit = caster.intersect(ray);
  }
}

Transmission transmission(const Scene& scene, RayCaster& caster, PathEnd start, float distance) {
  Transmission through;
  while (true) {
    std::optional<SurfaceHit> hit;
    if (scene.needs.boundaries) hit = caster.intersect(start.ray);
    const bool ends = !hit || !(hit->t < distance);
    SampledSpectrum passed(1.0F);
    start.medium.attenuate(passed, start.medium.march(start.ray, ends ? distance : hit->t, kInfinity).column);
    through.transmittance *= passed;
    if (start.medium.scattering != nullptr) through.density *= passed;
    // As nothing blocks the way, a surface that is no boundary is its end, but for rounding.
    if (ends || !boundary(scene, *hit)) return through;
    distance -= hit->t;
    start.ray = pass_boundaries(scene, start, start.ray, *hit);
  }
}

}  // namespace abbe

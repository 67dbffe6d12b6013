#include "transport/path/free_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/extent.h"

namespace abbe {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool boundary(const Scene& scene, const SurfaceHit& hit) {
  return is_boundary(scene.materials[scene.shapes[hit.shape].material]);
}

// Brings the lane densities to units of the greatest of them, so that they neither grow beyond all bounds nor
// vanish. What stands beside them changes as they do.
void rescale(Walk& walk) {
  PathPacket& packet = walk.packet;
  const float greatest = packet.lane_pdf.max();
  if (!(greatest > 0)) return;
  advance(packet, SampledSpectrum(1 / greatest), SampledSpectrum(1 / greatest));
  walk.connected *= 1 / greatest;
  walk.stretch.lanes *= 1 / greatest;
}

// e^(-s_k x) in units of the greatest lane's, and one over that.
struct Passed {
  SampledSpectrum lanes{1.0F};
  float unit = 1;
};
Passed pass(const MediumAt& medium, float distance) {
  const float least = medium.extinction_per_m.min();
  return {transmittance(medium.extinction_per_m - SampledSpectrum(least), distance),
          least > 0 ? std::exp(least * distance) : 1};
}

// Through the boundaries that touch where one is met on the way of `ray`, and over which it then spreads: the
// rest of the way.
Ray pass_boundaries(const Scene& scene, Surroundings& around, const SampledSpectrum& wavelengths_nm,
                    const Ray& ray, SurfaceHit& hit) {
  const TouchingSurfaces met = scene.touching(ray, hit);
  MediumStack beyond = around.inside;
  for (const bool entering : {false, true})
    for (const SurfaceHit& one : met.all())
      if ((one.normal.dot(ray.direction) < 0) == entering) beyond.cross(scene, one.shape, entering);
  around.enter(scene, beyond, wavelengths_nm);
  for (const SurfaceHit& one : met.all())
    hit.spread = std::max(hit.spread, std::abs((one.point - hit.point).dot(hit.normal)));
  return spawn(hit, ray.direction, ray.time);
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

// The point that far along a ray, where its matter lasts to `end`: another than its origin, a float step from
// it, where floats do not tell the two apart.
Imath::V3f other_point_along(const Ray& ray, float distance, float end, const Imath::V3f& end_normal) {
  const Imath::V3f point = point_along(ray, distance, end, end_normal);
  if (point != ray.origin) return point;
  const auto step = static_cast<float>(2 * float_step(largest_coordinate(Imath::V3d(point))));
  return ray.origin + ray.direction * std::min(step, end / 2);
}

// Takes the walk as far as its matter lasts along `ray`, or to where the hero's optical `depth` is used up.
// Whether it is.
bool scatters_on(Walk& walk, const Ray& ray, const std::optional<SurfaceHit>& hit, float& depth,
                 const StretchVisitor& visitor) {
  const MediumAt& medium = walk.around.medium;
  const float distance = hit ? hit->t : kInfinity;
  if (medium.scattering == nullptr) {
    medium.attenuate(walk.packet.throughput, medium.march(ray, distance, kInfinity).column);
    return false;
  }
  const Imath::V3f end_normal = hit ? hit->normal : Imath::V3f(0);
  walk.stretch = {ray, medium.grid == nullptr ? distance : 0, walk.packet.lane_pdf.sum(), end_normal};
  if (visitor && walk.stretch.length > 0) visitor(walk.stretch);
  const float extinction = medium.extinction_per_m[walk.packet.hero];
  const GridStretch way = medium.march(ray, distance, extinction > 0 ? depth / extinction : kInfinity);
  const Passed passed = pass(medium, way.column);
  if (way.reached) {
    advance(walk.packet, passed.lanes * medium.scattering_per_m, passed.lanes * medium.extinction_per_m);
    walk.stretch.lanes *= passed.unit;
    rescale(walk);
    walk.ray.origin = other_point_along(ray, way.distance, distance, end_normal);
    return true;
  }
  advance(walk.packet, passed.lanes, passed.lanes);
  walk.connected *= passed.unit;
  rescale(walk);
  depth -= extinction > 0 ? extinction * way.column : 0;
  return false;
}

}  // namespace

Imath::V3f point_along(const Ray& ray, float distance, float end, const Imath::V3f& end_normal) {
  const Imath::V3d direction(ray.direction);
  const Imath::V3d normal(end_normal);
  Imath::V3d point = Imath::V3d(ray.origin) + direction * static_cast<double>(distance);
  const double least = static_cast<double>(offset_length(Imath::V3f(point)));
  if (const double towards = normal.dot(direction); towards != 0) {
    const double off = (static_cast<double>(end) - static_cast<double>(distance)) * std::abs(towards);
    if (off < least) point -= normal * std::copysign(least - off, towards);
  }
  return rounded_back(point, direction);
}

Arrival propagate(const Scene& scene, RayCaster& caster, const Imath::V2f& u, Walk& walk,
                  std::optional<SurfaceHit>& hit, const StretchVisitor& visitor) {
  // A double has room for the digits of both numbers, and for those of what they are short of one.
  constexpr double kDigits = 0x1p-24;
  const double drawn = static_cast<double>(u.x) + (static_cast<double>(u.y) + kDigits / 2) * kDigits;
  auto depth = static_cast<float>(-std::log(1 - drawn));
  Ray ray = walk.ray;
  float gone = 0;  // to its origin
  while (true) {
    if (scatters_on(walk, ray, hit, depth, visitor)) return Arrival::matter;
    if (!hit) return Arrival::outside;
    if (const std::optional<SurfaceHit> surface = surface_at(scene, ray, *hit)) {
      hit = surface;
      hit->t += gone;
      return Arrival::surface;
    }
    gone += hit->t;
    ray = pass_boundaries(scene, walk.around, walk.packet.wavelengths.lambda_nm, ray, *hit);
    if (scene.hides_beyond(*hit, ray.direction, ray.time)) return Arrival::hidden;
    hit = caster.intersect(ray);
  }
}

Transmission transmission(const Scene& scene, RayCaster& caster, Ray ray, Surroundings around,
                          const SampledSpectrum& wavelengths_nm, float distance) {
  Transmission through;
  while (true) {
    std::optional<SurfaceHit> hit;
    if (scene.needs.boundaries) hit = caster.intersect(ray);
    const bool ends = !hit || !(hit->t < distance);
    SampledSpectrum passed(1.0F);
    around.medium.attenuate(passed, around.medium.march(ray, ends ? distance : hit->t, kInfinity).column);
    through.transmittance *= passed;
    if (around.medium.scattering != nullptr) through.density *= passed;
    // As nothing blocks the way, a surface that is no boundary is its end, but for rounding.
    if (ends || !boundary(scene, *hit)) return through;
    distance -= hit->t;
    ray = pass_boundaries(scene, around, wavelengths_nm, ray, *hit);
  }
}

std::optional<Transmission> unblocked_transmission(const Scene& scene, RayCaster& caster,
                                                   const BasicRay<double>& way, const Ray& ray,
                                                   const Surroundings& around,
                                                   const SampledSpectrum& wavelengths_nm, float distance) {
  if (caster.occluded(way)) return std::nullopt;
  return transmission(scene, caster, ray, around, wavelengths_nm, distance);
}

}  // namespace abbe

#include "lens/trace.h"

#include <cmath>

#include <fmt/format.h>

#include "materials/interface/snell.h"

namespace abbe::lens {
namespace {

using V3d = Imath::V3d;

// What stops a ray at a surface, to which `along` leads towards +z; its point, normal and length go to `hit`,
// in the surface's own coordinates.
RayEnd meet(const SurfaceBetween& at, Apertures apertures, const Ray& along, RayHit& hit) {
  const auto t = at.surface.profile.intersect(along);
  if (!t) return RayEnd::missed;
  hit.point = along.origin + *t * along.direction;
  hit.length_mm = *t;
  const double r2 = hit.point.x * hit.point.x + hit.point.y * hit.point.y;
  if (const auto& aperture = at.surface.semi_aperture_mm;
      apertures == Apertures::obeyed && aperture && r2 > *aperture * *aperture)
    return RayEnd::stopped;
  hit.normal = at.surface.profile.normal(hit.point);
  return RayEnd::image;
}

Ray to_local(const SystemAt::Frame& frame, const Ray& ray) {
  if (!frame.tilted) return {ray.origin - frame.vertex, ray.direction};
  return {(ray.origin - frame.vertex) * frame.to_local, ray.direction * frame.to_local};
}

void to_world(const SystemAt::Frame& frame, const V3d& direction, RayHit& hit) {
  hit.point = (frame.tilted ? hit.point * frame.to_world : hit.point) + frame.vertex;
  if (frame.tilted) hit.normal = hit.normal * frame.to_world;
  hit.direction = (frame.tilted ? direction * frame.to_world : direction).normalized();
}

SurfaceBetween surface_between(const SystemAt& at, std::size_t i) {
  return {at.surface(i), at.frames[i], at.n[i], at.n[i + 1]};
}

}  // namespace

RayEnd cross(const SurfaceBetween& at, Apertures apertures, const Ray& ray, RayHit& hit) {
  const Ray local = to_local(at.frame, ray);
  if (const RayEnd end = meet(at, apertures, local, hit); end != RayEnd::image) return end;
  const auto onwards = refract<double>(-local.direction, -hit.normal, at.n_behind / at.n_before);
  if (!onwards) return RayEnd::total_reflection;
  to_world(at.frame, *onwards, hit);
  return RayEnd::image;
}

RayEnd cross_back(const SurfaceBetween& at, Apertures apertures, const Ray& ray, RayHit& hit) {
  const Ray local = to_local(at.frame, ray);
  const Ray reversed{local.origin, -local.direction};
  if (const RayEnd end = meet(at, apertures, reversed, hit); end != RayEnd::image) return end;
  const auto onwards = refract<double>(reversed.direction, hit.normal, at.n_before / at.n_behind);
  if (!onwards) return RayEnd::total_reflection;
  to_world(at.frame, *onwards, hit);
  return RayEnd::image;
}

RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures, std::size_t surfaces) {
  RayPath path;
  path.last = ray;
  path.hits.reserve(surfaces);
  for (std::size_t i = 0; i < surfaces; ++i) {
    RayHit hit{};
    path.end = cross(surface_between(at, i), apertures, path.last, hit);
    path.at = i;
    if (!path.reached()) return path;
    path.hits.push_back(hit);
    path.last = {hit.point, hit.direction};
  }
  path.at = surfaces;
  if (surfaces < at.size()) return path;
  if (!(path.last.direction.z > 0)) {
    path.end = RayEnd::missed;
    return path;
  }
  path.last_length_mm = (at.vertex_z.back() - path.last.origin.z) / path.last.direction.z;
  path.last.origin += path.last_length_mm * path.last.direction;
  return path;
}

RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures) {
  return trace(at, ray, apertures, at.size());
}

V3d local_point(const SystemAt& at, std::size_t surface, const V3d& point) {
  return (point - at.frames[surface].vertex) * at.frames[surface].to_local;
}

namespace {

// The surface of the denser side's glass, seen from where the light comes.
FresnelPower<double> surface_power(const SurfaceBetween& at, double wavelength_nm, double cos_i) {
  const bool leaving = !at.surface.behind;
  return leaving ? coated_power(at.surface.coating, wavelength_nm, at.n_before, 0, cos_i, true, at.n_behind)
                 : coated_power(at.surface.coating, wavelength_nm, at.n_behind, 0, cos_i, false, at.n_before);
}

}  // namespace

WeakenedLight::WeakenedLight(const V3d& direction) {
  const V3d aside = std::abs(direction.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0);
  first_ = direction.cross(aside).normalized();
  second_ = direction.cross(first_);
}

void WeakenedLight::cross(const SurfaceBetween& at, double wavelength_nm, const V3d& from,
                          const RayHit& hit) {
  if (at.n_before == at.n_behind && at.surface.coating.layers.empty()) return;  // as at a stop
  const auto power = surface_power(at, wavelength_nm, std::min(1.0, from.dot(hit.normal)));
  const V3d across = from.cross(hit.normal);
  const V3d s = across.length2() > 0 ? across.normalized() : hit.normal.cross(first_).normalized();
  const V3d p_before = s.cross(from);
  const V3d s_behind = std::sqrt(power.Ts) * s;
  const V3d p_behind = std::sqrt(power.Tp) * s.cross(hit.direction);
  first_ = first_.dot(s) * s_behind + first_.dot(p_before) * p_behind;
  second_ = second_.dot(s) * s_behind + second_.dot(p_before) * p_behind;
}

double transmittance(const SystemAt& at, const Ray& start, const RayPath& path) {
  V3d from = start.direction;
  WeakenedLight light(from);
  double depth = 0;
  for (std::size_t i = 0; i < path.hits.size(); ++i) {
    const RayHit& hit = path.hits[i];
    light.cross(surface_between(at, i), at.wavelength_nm, from, hit);
    if (i > 0) depth += at.absorption_per_mm[i] * hit.length_mm;
    from = hit.direction;
  }
  depth += at.absorption_per_mm.back() * path.last_length_mm;
  return light.power() * std::exp(-depth);
}

std::string reason(const RayPath& path) {
  switch (path.end) {
    case RayEnd::missed:
      return fmt::format("misses surface {}", path.at + 1);
    case RayEnd::total_reflection:
      return fmt::format("is totally reflected at surface {}", path.at + 1);
    case RayEnd::stopped:
      return fmt::format("is stopped by the aperture of surface {}", path.at + 1);
    case RayEnd::image:
      break;
  }
  return "reaches the image";
}

}  // namespace abbe::lens

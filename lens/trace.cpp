#include "lens/trace.h"

#include <cmath>

#include <fmt/format.h>

#include "materials/interface/snell.h"

namespace abbe::lens {
namespace {

using V3d = Imath::V3d;

// One surface: its hit, or why there is none.
RayEnd pass(const SystemAt& at, std::size_t i, Apertures apertures, const Ray& ray, RayHit& hit) {
  const Surface& surface = at.surface(i);
  const SystemAt::Frame& frame = at.frames[i];
  const Ray local{(ray.origin - frame.vertex) * frame.to_local, ray.direction * frame.to_local};
  const auto t = surface.profile.intersect(local);
  if (!t) return RayEnd::missed;
  const V3d point = local.origin + *t * local.direction;
  if (apertures == Apertures::obeyed && surface.semi_aperture_mm &&
      std::hypot(point.x, point.y) > *surface.semi_aperture_mm)
    return RayEnd::stopped;
  const V3d normal = surface.profile.normal(point);
  const auto onwards = refract<double>(-local.direction, -normal, at.n[i + 1] / at.n[i]);
  if (!onwards) return RayEnd::total_reflection;
  hit = {point * frame.to_world + frame.vertex, normal * frame.to_world,
         (*onwards * frame.to_world).normalized(), *t};
  return RayEnd::image;
}

}  // namespace

RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures, std::size_t surfaces) {
  RayPath path;
  path.last = ray;
  path.hits.reserve(surfaces);
  for (std::size_t i = 0; i < surfaces; ++i) {
    RayHit hit{};
    path.end = pass(at, i, apertures, path.last, hit);
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
FresnelPower<double> surface_power(const SystemAt& at, std::size_t i, double cos_i) {
  const Surface& surface = at.surface(i);
  const bool leaving = !surface.behind && i > 0;
  return leaving ? coated_power(surface.coating, at.wavelength_nm, at.n[i], 0, cos_i, true, at.n[i + 1])
                 : coated_power(surface.coating, at.wavelength_nm, at.n[i + 1], 0, cos_i, false, at.n[i]);
}

// The field behind the surface, s and p of it weakened each by its own amplitude.
V3d weakened(const V3d& field, const V3d& from, const RayHit& hit, const FresnelPower<double>& power) {
  const V3d across = from.cross(hit.normal);
  const V3d s = across.length2() > 0 ? across.normalized() : hit.normal.cross(field).normalized();
  const V3d p_before = s.cross(from);
  const V3d p_behind = s.cross(hit.direction);
  return std::sqrt(power.Ts) * field.dot(s) * s + std::sqrt(power.Tp) * field.dot(p_before) * p_behind;
}

}  // namespace

double transmittance(const SystemAt& at, const Ray& start, const RayPath& path) {
  V3d from = start.direction;
  const V3d aside = std::abs(from.x) < 0.5 ? V3d(1, 0, 0) : V3d(0, 1, 0);
  V3d first = from.cross(aside).normalized();
  V3d second = from.cross(first);
  double depth = 0;
  for (std::size_t i = 0; i < path.hits.size(); ++i) {
    const RayHit& hit = path.hits[i];
    const auto power = surface_power(at, i, std::min(1.0, from.dot(hit.normal)));
    first = weakened(first, from, hit, power);
    second = weakened(second, from, hit, power);
    if (i > 0) depth += at.absorption_per_mm[i] * hit.length_mm;
    from = hit.direction;
  }
  depth += at.absorption_per_mm.back() * path.last_length_mm;
  return (first.length2() + second.length2()) / 2 * std::exp(-depth);
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

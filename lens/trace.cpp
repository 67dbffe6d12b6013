#include "lens/trace.h"

#include <cmath>

#include <fmt/format.h>

namespace abbe::lens {
namespace {

using V3d = Imath::V3d;

RayEnd end_at(const Crossing<double>& crossing, Apertures apertures) {
  if (!crossing.intersects) return RayEnd::missed;
  if (apertures == Apertures::obeyed && !crossing.within) return RayEnd::stopped;
  return crossing.refracted ? RayEnd::image : RayEnd::total_reflection;
}

SurfaceBetween<double> surface_between(const SystemAt& at, std::size_t i) {
  return {at.surface(i), at.frames[i], at.n[i], at.n[i + 1]};
}

}  // namespace

RayPath trace(const SystemAt& at, const Ray& ray, Apertures apertures, std::size_t surfaces) {
  RayPath path;
  path.last = ray;
  path.hits.reserve(surfaces);
  for (std::size_t i = 0; i < surfaces; ++i) {
    const auto crossing = cross(surface_between(at, i), path.last);
    const RayHit& hit = crossing.hit;
    path.end = end_at(crossing, apertures);
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

double transmittance(const SystemAt& at, const Ray& start, const RayPath& path) {
  V3d from = start.direction;
  UnpolarisedFields<double> light(from);
  double depth = 0;
  for (std::size_t i = 0; i < path.hits.size(); ++i) {
    const RayHit& hit = path.hits[i];
    light.apply(surface_between(at, i), at.wavelength_nm, from, hit, {});
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

#pragma once

#include <embree3/rtcore.h>

#include "scene/shapes/ray.h"

namespace abbe {

/// Converts a ray to Embree's format: coordinates rounded to the nearest float, tnear 0, and a mask that
/// accepts all geometry. The direction need not have unit length.
[[nodiscard]] inline RTCRay embree_ray(const BasicRay<double>& ray) {
  RTCRay r{};
  r.org_x = static_cast<float>(ray.origin.x);
  r.org_y = static_cast<float>(ray.origin.y);
  r.org_z = static_cast<float>(ray.origin.z);
  r.dir_x = static_cast<float>(ray.direction.x);
  r.dir_y = static_cast<float>(ray.direction.y);
  r.dir_z = static_cast<float>(ray.direction.z);
  r.tfar = static_cast<float>(ray.t_max);
  r.time = ray.time;
  r.mask = ~0U;
  return r;
}

/// An Embree query for a ray, without a hit yet.
[[nodiscard]] inline RTCRayHit embree_query(const BasicRay<double>& ray) {
  RTCRayHit query{embree_ray(ray), {}};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

}  // namespace abbe

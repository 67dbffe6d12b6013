#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <embree3/rtcore.h>

#include "scene/geometry.h"
#include "scene/shapes/ray.h"

namespace abbe {

/// Embree mask of all surfaces, transmitting ones included. Shadow rays are blocked by these alone.
inline constexpr unsigned kOpaque = 1;
/// Embree mask of boundaries of media without an interface, which cast no shadow.
inline constexpr unsigned kBoundary = 2;

/// Number of rays in an Embree packet. Packets are not declared coherent, so Embree traverses them ray by ray
/// and shares only the overhead of the call. A hit, ties included, therefore depends on its ray alone.
inline constexpr std::size_t kPacket = 8;

/// Context of a query: what the callbacks need in addition to Embree's float rays, and what they find in
/// addition to its float hits. Embree's ray `id` is the index into `rays` and `curved_hit`. One context
/// serves one thread.
struct ExactContext : RTCIntersectContext {
  explicit ExactContext(const std::vector<AttachedGeometry>& all) : RTCIntersectContext(), attached(all) {
    rtcInitIntersectContext(this);
  }
  const std::vector<AttachedGeometry>& attached;  ///< By index of the shape; must outlive the context.
  std::array<BasicRay<double>, kPacket> rays;
  std::array<ShapeHit<double>, kPacket> curved_hit;  ///< Hit on a curved shape, per ray.
  std::vector<SurfaceHit>* all = nullptr;  ///< Receives every hit; null if the nearest is requested.
};

/// Computes a hit that Embree found for ray number `ray` in double precision. Nothing if the ray does not
/// cross the triangle's plane in double at t in (0, t_max). Hits on curved shapes come from
/// `ExactContext::curved_hit`. `retreat_m` stays 0.
[[nodiscard]] std::optional<SurfaceHit> resolve_hit(const RTCHit& hit, const ExactContext& context,
                                                    std::size_t ray);

/// Resolves the nearest hit, which Embree found at the float distance `t` [m], as `resolve_hit` does, and
/// sets its `retreat_m`. That distance is the amount by which the exact hit lies behind Embree's, which grows
/// at grazing incidence, plus a few float steps. The latter are at most half the length of the current
/// segment, which may have begun at a nearby boundary.
[[nodiscard]] std::optional<SurfaceHit> resolve_nearest(const RTCHit& hit, float t,
                                                        const ExactContext& context, std::size_t ray);

/// Embree filter that rejects triangles whose plane the ray does not cross in double precision at t in (0,
/// t_max). It sets their `valid` to 0.
void reject_behind(const RTCFilterFunctionNArguments* args);
/// Embree filter that appends every hit to `ExactContext::all`, and rejects it so that traversal continues to
/// the end of the ray.
void collect_hits(const RTCFilterFunctionNArguments* args);

/// Makes `attached`, which must outlive it, a user geometry of Embree. That is intersected in double: a
/// curved shape, each triangle of a set, or a moving instance, which has `kTimeSlices` primitives.
void set_callbacks(RTCGeometryTy* geometry, AttachedGeometry& attached);

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

/// An Embree query without a hit yet.
[[nodiscard]] inline RTCRayHit without_hit(const RTCRay& ray) {
  RTCRayHit query{ray, {}};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

/// The first `count` rays of a context as an Embree packet of `kPacket`; `count` is in [1, `kPacket`].
/// `valid` is -1 for these and 0, which disables, for the rest. `mask` selects the geometry: `kOpaque`,
/// `kBoundary` or ~0U for both. Ray `id`s are indices into the context.
struct alignas(32) Packet {
  std::array<int, kPacket> valid;
  RTCRayHit8 query;

  Packet(const ExactContext& context, std::size_t count, unsigned mask) {
    for (std::size_t i = 0; i < kPacket; ++i) {
      valid[i] = i < count ? -1 : 0;
      const RTCRay ray = embree_ray(context.rays[std::min(i, count - 1)]);
      query.ray.org_x[i] = ray.org_x;
      query.ray.org_y[i] = ray.org_y;
      query.ray.org_z[i] = ray.org_z;
      query.ray.dir_x[i] = ray.dir_x;
      query.ray.dir_y[i] = ray.dir_y;
      query.ray.dir_z[i] = ray.dir_z;
      query.ray.tnear[i] = 0;
      query.ray.time[i] = ray.time;
      query.ray.tfar[i] = ray.tfar;
      query.ray.mask[i] = mask;
      query.ray.id[i] = static_cast<unsigned>(i);
      query.ray.flags[i] = 0;
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
  }
  /// Distance of the hit of ray `i` in units of its direction; its t_max if there is none.
  [[nodiscard]] float t(std::size_t i) const { return query.ray.tfar[i]; }
  /// Hit of ray `i` in Embree's format for single rays; valid only if its `geomID` is not the invalid one.
  [[nodiscard]] RTCHit hit(std::size_t i) const {
    RTCHit one{};
    one.u = query.hit.u[i];
    one.v = query.hit.v[i];
    one.primID = query.hit.primID[i];
    one.geomID = query.hit.geomID[i];
    one.instID[0] = query.hit.instID[0][i];
    return one;
  }
};

}  // namespace abbe

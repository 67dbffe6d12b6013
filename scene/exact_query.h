#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/geometry.h"

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
  std::array<ShapeHit<double>, kPacket> curved_hit;  ///< Hit on a sphere or disc, per ray.
  std::vector<SurfaceHit>* all = nullptr;  ///< Receives every hit; null if the nearest is requested.
};

/// Computes a hit that Embree found for ray number `ray` in double precision. Nothing if the ray does not
/// cross the triangle's plane in double at t in (0, t_max). Hits on spheres and discs come from
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

/// Sets Embree's callbacks for a sphere or disc. The caller has made it the geometry's user data
/// (`rtcSetGeometryUserData`); it must outlive the geometry. The second argument only selects the overload.
void set_callbacks(RTCGeometryTy* geometry, const Sphere& sphere);
void set_callbacks(RTCGeometryTy* geometry, const Disc& disc);
/// Sets Embree's callbacks for a set of triangles that are intersected in double. The set is the user data.
void set_callbacks(RTCGeometryTy* geometry, const TriangleSet& set);
/// Sets Embree's callbacks for a moving instance, which is the user data. It has `kTimeSlices` primitives.
void set_callbacks(RTCGeometryTy* geometry, const SceneInstance& moving);

}  // namespace abbe

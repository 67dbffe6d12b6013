#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/geometry.h"

namespace abbe {

/// Embree masks: surfaces, and boundaries of media without an interface. Shadow rays ignore the latter,
/// because they cast no shadow.
inline constexpr unsigned kOpaque = 1;
inline constexpr unsigned kBoundary = 2;

/// Number of rays in an Embree packet. Packets are not declared coherent, so Embree traverses them ray by ray
/// and shares only the overhead of the call. A hit, ties included, therefore depends on its ray alone.
inline constexpr std::size_t kPacket = 8;

/// Context of a query: what the callbacks need in addition to Embree's float rays, and what they find in
/// addition to its float hits. `id` identifies a ray.
struct ExactContext : RTCIntersectContext {
  explicit ExactContext(const std::vector<AttachedGeometry>& all) : RTCIntersectContext(), attached(all) {
    rtcInitIntersectContext(this);
  }
  const std::vector<AttachedGeometry>& attached;
  std::array<BasicRay<double>, kPacket> rays;
  std::array<ShapeHit<double>, kPacket> curved_hit;  ///< Hit on a sphere or disc, per ray.
  std::vector<SurfaceHit>* all = nullptr;            ///< Receives every hit if all hits are requested.
};

/// Computes a hit that Embree found for ray number `ray` in double precision. Nothing if the ray does not
/// cross the triangle's plane in double.
[[nodiscard]] std::optional<SurfaceHit> resolve_hit(const RTCHit& hit, const ExactContext& context,
                                                    std::size_t ray);

/// Resolves the nearest hit, which Embree found at `t`, as `resolve_hit` does, and sets its `retreat_m`. That
/// distance is the difference between both hit distances, which grows at grazing incidence, plus a few float
/// steps. It is at most half the length of the current segment, which may have begun at a nearby boundary.
[[nodiscard]] std::optional<SurfaceHit> resolve_nearest(const RTCHit& hit, float t,
                                                        const ExactContext& context, std::size_t ray);

/// Embree filter that rejects triangles whose plane the ray does not cross in double precision.
void reject_behind(const RTCFilterFunctionNArguments* args);
/// Embree filter that passes every hit to `ExactContext::all`.
void collect_hits(const RTCFilterFunctionNArguments* args);

/// Sets Embree's callbacks for a sphere or disc, to which the geometry's `user_pointer` points.
void set_callbacks(RTCGeometryTy* geometry, const Sphere& sphere);
void set_callbacks(RTCGeometryTy* geometry, const Disc& disc);
/// Sets Embree's callbacks for a set of triangles that are intersected in double; `user_pointer` as above.
void set_callbacks(RTCGeometryTy* geometry, const TriangleSet& set);
/// Sets Embree's callbacks for a moving instance; `user_pointer` as above.
void set_callbacks(RTCGeometryTy* geometry, const SceneInstance& moving);

}  // namespace abbe

#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/geometry.h"

namespace abbe {

/// What rays meet; those that ask for shadows leave out the boundaries of matter, which throw none.
inline constexpr unsigned kOpaque = 1;
inline constexpr unsigned kBoundary = 2;

/// Rays that Embree is asked about at once. Packets that are not said to be coherent are traversed ray by
/// ray, and only what it costs to ask is shared: an answer depends on the ray alone, ties included, whichever
/// rays travel along.
inline constexpr std::size_t kPacket = 8;

/// What the callbacks need beyond Embree's float rays, and what they found beyond its float hits. Rays are
/// told apart by their `id`.
struct ExactContext : RTCIntersectContext {
  explicit ExactContext(const std::vector<AttachedGeometry>& all) : RTCIntersectContext(), attached(all) {
    rtcInitIntersectContext(this);
  }
  const std::vector<AttachedGeometry>& attached;
  std::array<BasicRay<double>, kPacket> rays;
  std::array<ShapeHit<double>, kPacket> nearest;  ///< On a sphere or disc.
  std::vector<SurfaceHit>* all = nullptr;         ///< Where every hit goes, if they are asked for.
};

/// What Embree found for the ray of that number, in double; nothing for the plane of a triangle that the ray
/// does not cross.
[[nodiscard]] std::optional<SurfaceHit> decide(const RTCHit& hit, const ExactContext& context,
                                               std::size_t ray);

/// The same of the nearest hit, which Embree found at `t`. Rays that leave to the side it came from start
/// before where that is, by more the more the face is grazed, and some floats more, but on this stretch of
/// the path: it may have begun at a boundary that is close.
[[nodiscard]] std::optional<SurfaceHit> nearest(const RTCHit& hit, float t, const ExactContext& context,
                                                std::size_t ray);

/// A filter that drops the triangles whose plane the ray does not cross in double.
void reject_behind(const RTCFilterFunctionNArguments* args);
/// A filter that passes every hit to `ExactContext::all`.
void collect(const RTCFilterFunctionNArguments* args);

/// Tells Embree how rays meet a sphere or disc, which `user_pointer` of the geometry is.
void set_callbacks(RTCGeometryTy* geometry, const Sphere& sphere);
void set_callbacks(RTCGeometryTy* geometry, const Disc& disc);
/// Tells Embree how rays meet the triangles of a set in double, likewise.
void set_callbacks(RTCGeometryTy* geometry, const TriangleSet& set);
/// Tells Embree how rays meet an instance that moves, likewise.
void set_callbacks(RTCGeometryTy* geometry, const SceneInstance& moving);

}  // namespace abbe

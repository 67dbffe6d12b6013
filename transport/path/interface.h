#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "scene/scene.h"
#include "transport/path/medium_stack.h"

namespace abbe {

/// Nested media: a surface is an interface only if the medium changes there. Of all shapes around a
/// point, the medium of the one with the highest priority counts [Schmidt2002]; among equals, that of the
/// smallest shape. A medium without an interface has the index of the medium around it and does not refract.
/// Coincident surfaces are crossed together, from the medium before all of them to the medium behind all of
/// them.

/// Crossing of a shape's surface, into the shape or out of it.
struct CrossedSurface {
  std::uint32_t shape;
  bool entering;
};

/// The one of several coincident surfaces that acts on a ray, and the media there.
struct ActingSurface {
  std::optional<std::size_t> acting;  ///< Index of the acting surface; none if nothing changes.
  /// Index outside the acting shape's own medium; nullptr is air.
  const RefractiveIndex* outside = nullptr;
  MediumStack media_behind = {};  ///< Media of a transmitted ray.
};

/// Decides which of several coincident surfaces acts on a ray in `media`. In this order:
/// - The first opaque surface acts.
/// - If the index changes, the surface of higher priority of the two that bound the media before and behind
///   acts. Among equals this is the later one of the scene.
/// - If the index does not change, the first sheet acts.
///
/// A shape that is left without having been entered counts as entered before.
[[nodiscard]] ActingSurface acting_surface(const Scene& scene, std::span<const CrossedSurface> surfaces,
                                           const MediumStack& media);

/// Interface at which a path that hits the scene at `first` interacts.
struct Interface {
  SurfaceHit hit;  ///< Hit on the acting surface.
  bool passes;     ///< True if no medium changes, so that the path continues straight.
  const RefractiveIndex* outside;
  MediumStack media_behind;
};
[[nodiscard]] Interface interface_at(const Scene& scene, const Ray& ray, const SurfaceHit& first,
                                     const MediumStack& media);

}  // namespace abbe

#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "scene/scene.h"
#include "transport/path/medium_stack.h"

namespace abbe {

// Nested media: a surface is an interface only if the medium changes there. At a point within several shapes
// the medium is that of the shape with the highest priority [Schmidt2002]; among equals, of the smallest. A
// medium without an interface has the index of the medium around it and does not refract. Coincident surfaces
// are crossed together, from the medium before all of them to the medium behind all of them.

/// Crossing of a shape's surface, into the shape or out of it.
struct CrossedSurface {
  std::uint32_t shape;  ///< Index into `Scene::shapes`.
  bool entering;        ///< True if the ray arrives against the shape's outward normal.
};

/// The one of several coincident surfaces that acts on a ray, and the media there.
struct ActingSurface {
  /// Position of the acting surface in the list of crossed surfaces; none if the ray continues straight.
  std::optional<std::size_t> acting;
  /// Refractive index of the medium on the side of the acting surface that is not in its own shape; for
  /// opaque surfaces and sheets, of the medium from which the ray arrives. nullptr is air.
  const RefractiveIndex* outside = nullptr;
  MediumStack media_behind = {};  ///< Media of a transmitted ray; those before an opaque surface.
};

/// Decides which of `surfaces`, which coincide and number at most `CoincidentHits::kMaxHits`, acts on a ray
/// in `media`. The first rule that applies decides:
/// - The first opaque surface of the list acts.
/// - If the index changes, the surface of higher priority of the two that bound the media before and behind
///   acts. Among equals this is the later one of the scene.
/// - If the index does not change, the first sheet of the list acts: a surface that encloses no medium.
///
/// A shape that is left without having been entered counts as entered before. Throws Error{resource} if more
/// than `MediumStack::kMaxShapes` media nest.
[[nodiscard]] ActingSurface acting_surface(const Scene& scene, std::span<const CrossedSurface> surfaces,
                                           const MediumStack& media);

/// Interface at which a path interacts with coincident surfaces.
struct Interface {
  SurfaceHit hit;                  ///< Hit on the acting surface, or on the first one if `passes`.
  bool passes;                     ///< True if no surface acts, so that the path continues straight.
  const RefractiveIndex* outside;  ///< See `ActingSurface::outside`.
  MediumStack media_behind;        ///< See `ActingSurface::media_behind`.
};
/// Interface of a path whose ray hits the scene first at `first`, in `media`. The coincidence radius of its
/// hit encloses all coincident surfaces. Throws as `acting_surface`.
[[nodiscard]] Interface interface_at(const Scene& scene, const Ray& ray, const SurfaceHit& first,
                                     const MediumStack& media);

}  // namespace abbe

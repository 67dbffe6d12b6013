#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "scene/scene.h"
#include "transport/path/medium_stack.h"

namespace abbe {

/// Where matter is nested, surfaces are interfaces only where what is there changes: of all the matter that a
/// point lies in, that of the highest priority [Schmidt2002], and among equals of the smallest shape. Matter
/// without an interface has the index of what it lies in, and changes nothing by which light is refracted.
/// Surfaces that touch are crossed together, from what was before all of them to what is behind.

/// A surface on a ray's way: into its shape, or out of it.
struct CrossedSurface {
  std::uint32_t shape;
  bool entering;
};

/// Which of several surfaces that touch acts on a ray, and what lies around it there.
struct ActingSurface {
  std::optional<std::size_t> acting;         ///< Which of them acts; none where nothing changes.
  const RefractiveIndex* outside = nullptr;  ///< Of the acting shape's own matter; nullptr is air.
  MediumStack beyond = {};                   ///< What a ray that is let through is in.
};

/// Tells which of the surfaces that a ray within `inside` meets together acts on it. The first opaque one
/// acts. Else, where the index changes, that of the higher priority of the two that bound what was before and
/// what is behind, of equals the later one of the scene; where it does not, the first sheet. A shape left
/// that was never entered counts as entered before.
[[nodiscard]] ActingSurface acting_surface(const Scene& scene, std::span<const CrossedSurface> surfaces,
                                           const MediumStack& inside);

/// The interface at which a path that meets the scene at `first` meets it.
struct Interface {
  SurfaceHit hit;  ///< With the acting surface.
  bool passes;     ///< Nothing changes.
  const RefractiveIndex* outside;
  MediumStack beyond;
};
[[nodiscard]] Interface interface_at(const Scene& scene, const Ray& ray, const SurfaceHit& first,
                                     const MediumStack& inside);

}  // namespace abbe

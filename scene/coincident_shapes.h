#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <ImathBox.h>
#include <ImathPlane.h>

#include "scene/scene.h"

namespace abbe {

// The functions below require the bounds that `Scene::commit` computes first, and never throw. Indices count
// from 0 in `Scene::shapes` or `Scene::lights`; "first" means the lowest index. A sheet is a transmitting
// surface that does not enclose a medium.

/// Finds the first shape at which light may have to cross two coincident surfaces, by `may_coincide`:
/// - a transmitting shape that coincides with an opaque one;
/// - a sheet that coincides with the surface of a medium.
/// Returns the index of the transmitting one; nothing if there is no such shape. If there are more than
/// `kMaxPairs` pairs, it is that of the first pair that was not compared.
[[nodiscard]] std::optional<std::uint32_t> find_coincident_shape(const Scene& scene);

/// The first two shapes of which rays hit only one, by the lower index and then the other, and the number of
/// further pairs.
struct LostSurfaces {
  std::uint32_t shape;  ///< Index into `Scene::shapes`, as is `on`.
  std::uint32_t on;
  std::size_t others;
};
/// Finds shapes that have no effect, or whose emission is lost, because another surface coincides with them:
/// - a sheet that coincides, by `overlaps`, with an opaque surface, another sheet or the interface of a
///   medium, unless it lies between two bodies of one material;
/// - an emitting opaque surface that coincides with an opaque one, which may emit too. The faces of a closed
///   mesh that emits only outward do not count where they look at those of the other surface;
/// - a body of a medium whose whole surface lies on an opaque body, by `coats`.
///
/// Nothing if there are none, or more than `kMaxPairs` pairs of shapes whose boxes overlap along x.
[[nodiscard]] std::optional<LostSurfaces> find_lost_surfaces(const Scene& scene);

/// Finds the first emitting shape whose light the probe misses because the shape lies on the probe. Returns
/// the index of its light in `Scene::lights`. The shape emits towards the probe and is within rounding of one
/// of the probe's `kRepresentativePoints`, so that rays from there start behind it. Nothing if there is none
/// or the camera is not a probe. Moving probes and shapes are not checked.
[[nodiscard]] std::optional<std::uint32_t> find_light_on_probe(const Scene& scene);

/// The region of a transmitting shape in which a wall, an opaque surface, crosses it or comes within float
/// resolution. Render coordinates [m].
struct NearWalls {
  Imath::Box3f box;  ///< Conservative box around that region; empty if there is none.
  /// Planes that together contain all walls near the shape. Empty if there is no wall, if a wall is not flat
  /// or moves, or if testing the planes would be slower than a ray query.
  std::vector<Imath::Plane3d> planes;
};
/// The walls near each shape, by index in `Scene::shapes`; empty for opaque shapes. For shapes reached after
/// `kMaxPairs` pairs, the box contains the whole shape and there are no planes.
[[nodiscard]] std::vector<NearWalls> walls_near_shapes(const Scene& scene);

/// Returns for each shape, by its index in `Scene::shapes`, a box in render coordinates [m]. It contains the
/// region where `Scene::coincident` may find another surface or the shape's own other side. The box is
/// conservative, and empty if there is none. `Scene::commit` calls this after it has measured the shapes.
/// Fallbacks:
/// - the overlap of the bounding boxes for moving shapes and ellipsoids, and if comparing the faces would
/// delay the render;
/// - the whole of every shape if there are more than `kMaxPairs` pairs of shapes.
[[nodiscard]] std::vector<Imath::Box3f> coincidence_regions(const Scene& scene);

}  // namespace abbe

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

/// A shape, and the shape that it coincides with, as indices into `Scene::shapes`.
struct CoincidentPair {
  std::uint32_t shape;
  std::uint32_t on;
};

/// Finds the first shape at which light may have to cross two coincident surfaces, by `may_coincide`:
/// - a transmitting shape that coincides with an opaque one;
/// - a sheet that coincides with the surface of a medium.
/// Here `shape` is the transmitting one. Nothing if there is no such shape. If there are more than
/// `kMaxPairs` pairs, the first pair that was not compared is returned.
[[nodiscard]] std::optional<CoincidentPair> find_coincident_pair(const Scene& scene);

/// Finds the first sheet that may have no effect because it coincides, by `overlaps`, with another surface
/// that rays hit instead. The other surface, `on`, is opaque, another sheet, or the interface of a medium. A
/// sheet between two bodies of one material is not reported. Nothing if there is no such sheet, or if there
/// are more than `kMaxPairs` pairs of shapes with intersecting boxes.
[[nodiscard]] std::optional<CoincidentPair> find_hidden_sheet(const Scene& scene);

/// A body of a medium that coincides with the whole surface of an opaque body, so that the medium has no
/// thickness.
struct IneffectiveCoat {
  static constexpr double kBaseReflectance = 0.5;  ///< Reflectance of the example in `reflectance`.
  std::uint32_t shape;                             ///< Index of the medium's body.
  std::uint32_t on;                                ///< Index of the opaque body.
  /// Total reflectance, in [0, 1], at normal incidence and 550 nm of such a coat of finite thickness on a
  /// diffuse surface of reflectance `kBaseReflectance`. Absorption in the coat is neglected. Nothing for a
  /// medium without an interface.
  std::optional<double> reflectance;
};
/// Finds the first body of a medium that has no effect, because rays hit an opaque surface instead. Its whole
/// surface lies on an opaque body, by `coats`. Nothing if there is none, or if there are more than
/// `kMaxPairs` pairs of shapes.
[[nodiscard]] std::optional<IneffectiveCoat> find_ineffective_coat(const Scene& scene);

/// Finds the first emitting shape whose light the probe misses because the shape lies on the probe. Returns
/// the index of its light in `Scene::lights`. The shape emits towards the probe and is within rounding of one
/// of the probe's `kRepresentativePoints`, so that rays from there start behind it. Nothing if there is none
/// or the camera is not a probe. Moving probes and shapes are not checked.
[[nodiscard]] std::optional<std::uint32_t> find_light_on_probe(const Scene& scene);

/// A light, and the opaque shape that it coincides with.
struct CoincidentLight {
  std::uint32_t light;  ///< Index into `Scene::lights`.
  /// Index into `Scene::shapes`; the light's own shape if its triangles overlap each other.
  std::uint32_t on;
};

/// Finds a light that may lose part of its emission on an opaque surface. Rays hit only one of two coincident
/// opaque surfaces, although the points sampled on the light lie on both. If there are several, the light
/// whose bounding box has the smallest minimum x is returned. The candidates are lights that emit anything:
/// - an emitting opaque surface that coincides, by `overlaps`, with an opaque surface, which may emit too;
/// - an emitting mesh with duplicate triangles or, by `overlaps_itself`, coincident ones;
/// - a point or spot light that does not move and lies, by `is_on_surface`, on an opaque surface.
///
/// Not reported:
/// - a light under glass;
/// - a closed mesh that emits only outward and stands on the surface. The two faces in contact have opposite
///   normals, so nothing sees them.
///
/// Nothing if there is none, or if there are more than `kMaxPairs` pairs. Only boxes that overlap along x
/// are compared, and only triangles within the boxes of lights. For small lights the cost is therefore that
/// of sorting by x.
[[nodiscard]] std::optional<CoincidentLight> find_hidden_light(const Scene& scene);

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

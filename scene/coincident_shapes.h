#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <ImathBox.h>
#include <ImathPlane.h>

#include "scene/scene.h"

namespace abbe {

/// A shape, and the shape that it coincides with.
struct CoincidentPair {
  std::uint32_t shape;
  std::uint32_t on;
};

/// Finds the first shape at which light may have to cross two coincident surfaces, by `may_coincide`:
/// - a transmitting shape that coincides with an opaque one;
/// - a sheet that coincides with the surface of a medium.
/// A pair is also returned if there are too many to compare.
[[nodiscard]] std::optional<CoincidentPair> find_coincident_pair(const Scene& scene);

/// Finds the first sheet that may have no effect because it coincides, by `overlaps`, with another surface
/// that rays hit instead. The other surface is opaque, another sheet, or the interface between media of
/// different indices. A sheet between two bodies of one material is not reported.
[[nodiscard]] std::optional<CoincidentPair> find_hidden_sheet(const Scene& scene);

/// A body of a medium that coincides with the whole surface of an opaque body, so that the medium has no
/// thickness.
struct IneffectiveCoat {
  static constexpr double kBaseReflectance = 0.5;
  std::uint32_t shape;
  std::uint32_t on;
  /// Reflectance at normal incidence and 550 nm of a diffuse surface of reflectance `kBaseReflectance` under
  /// such a coat. Nothing for a medium without an interface.
  std::optional<double> reflectance;
};
/// Finds the first body of a medium that has no effect, because rays hit an opaque surface instead. Its whole
/// surface lies on an opaque body, by `coats`. Nothing if there are more than `kMaxPairs` pairs of shapes.
[[nodiscard]] std::optional<IneffectiveCoat> find_ineffective_coat(const Scene& scene);

/// Finds the first emitting shape in front of a probe whose light the probe misses, as an index into
/// `Scene::lights`. The light is within rounding of one of the probe's points, so that rays from that point
/// start behind it.
[[nodiscard]] std::optional<std::uint32_t> find_light_on_probe(const Scene& scene);

/// A light, and the shape that it coincides with.
struct CoincidentLight {
  std::uint32_t light;  ///< Index into `Scene::lights`.
  /// Index into `Scene::shapes`; the light's own shape if its triangles overlap each other.
  std::uint32_t on;
};

/// Finds the first light, in order of increasing x, part of whose emission may be lost. Rays hit only one of
/// two coincident opaque surfaces, although the points sampled on the light lie on both. The candidates are:
/// - an emitting opaque surface that coincides, by `overlaps`, with an opaque surface, which may emit too;
/// - an emitting mesh with duplicate triangles or, by `overlaps_itself`, coincident ones;
/// - a point or spot light that lies, by `is_on_surface`, on an opaque surface.
/// Not reported: lights under glass, and closed meshes that emit only outward whose coincident faces look at
/// the other surface. Spheres count only if they have the same center and radius. Nothing if there are more
/// than `kMaxPairs` pairs. The cost is that of sorting if the lights are small: only boxes that overlap along
/// x are compared, and only triangles within the boxes of lights.
[[nodiscard]] std::optional<CoincidentLight> find_hidden_light(const Scene& scene);

/// The region of a transmitting shape in which an opaque surface crosses it or comes within float resolution.
struct NearWalls {
  Imath::Box3f box;  ///< Conservative box around that region; empty if there is none.
  /// Planes that contain all opaque surfaces near the shape. Empty if a surface is not flat, or if testing
  /// the planes would be slower than a ray query.
  std::vector<Imath::Plane3d> planes;
};
/// The walls near each shape, by index; empty for opaque shapes. The box contains the whole shape if
/// comparing the surfaces would take seconds.
[[nodiscard]] std::vector<NearWalls> walls_near_shapes(const Scene& scene);

}  // namespace abbe

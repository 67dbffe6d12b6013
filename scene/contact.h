#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <ImathBox.h>
#include <ImathPlane.h>

#include "scene/scene.h"

namespace abbe {

/// A shape, and one that it lies on.
struct Contact {
  std::uint32_t shape;
  std::uint32_t on;
};

/// The first shape of the scene at which light may have to cross two surfaces at once: one that lets light on
/// and lies on something opaque, or a sheet that lies on a face of matter, by `may_coincide`. It may be, too,
/// where so many shapes are near each other that comparing them would take seconds.
[[nodiscard]] std::optional<Contact> crossed_at_once(const Scene& scene);

/// The first sheet that may be lost where it lies, by `lies_on`: on something opaque, on another sheet, or
/// between matter of two indices, the interface of which is met instead. One between two bodies of one
/// material is not.
[[nodiscard]] std::optional<Contact> lost_sheet(const Scene& scene);

/// A body of a medium without thickness on an opaque body.
struct LostCoat {
  static constexpr double kBelow = 0.5;
  std::uint32_t shape;
  std::uint32_t on;
  /// Reflectance along the normal, at 550 nm, of a diffuse surface of reflectance `kBelow` under such a coat;
  /// nothing for a medium without an interface.
  std::optional<double> reflectance;
};
/// The first body of a medium that has no effect, as an opaque surface is hit instead. All of its surface
/// lies, by `coats`, on that of an opaque body. None is found where there are more than `kMostPairs` pairs of
/// shapes.
[[nodiscard]] std::optional<LostCoat> lost_coat(const Scene& scene);

/// The first emitting shape in front of a meter whose light is missed, as an index into `Scene::lights`. It
/// is within the rounding of one of the meter's points, so that rays from there start behind it.
[[nodiscard]] std::optional<std::uint32_t> light_on_meter(const Scene& scene);

/// A lamp, and the shape that it touches.
struct LampContact {
  std::uint32_t light;  ///< Index into `Scene::lights`.
  std::uint32_t on;     ///< Index into `Scene::shapes`; the lamp's own where its triangles are doubled.
};

/// The first lamp, from low x to high, that light may be lost of, as rays meet but one of the opaque surfaces
/// at one place while the lamp's points are reached all the same: an opaque surface that emits and, by
/// `lies_on`, lies on an opaque one, which may be a lamp too; a mesh that emits and has triangles with the
/// same corners or, by `lies_on_itself`, in each other; or a point or spot that, by `stands_on`, stands on
/// something opaque. Lamps under glass are not, nor is a closed mesh that emits outward alone where it and
/// what it touches face each other: a sheet counts as seen from where it faces. Of spheres, those alone are
/// found that are balls of the same middle and radius. It looks at pairs of boxes that meet along x, and at
/// triangles within the boxes of lamps alone, so that it takes as long as sorting where lamps are small; none
/// is told where there are more than `kMostPairs`.
[[nodiscard]] std::optional<LampContact> lost_lamp(const Scene& scene);

/// Where anything opaque comes as near to a shape that lets light on as floats tell, or crosses it.
struct NearWalls {
  Imath::Box3f box;  ///< Around all such places, and perhaps some of the shape beside them; empty for none.
  /// Those in which all of what is opaque there lies, if it is flat and they are so few that asking each is
  /// quick; else none.
  std::vector<Imath::Plane3d> planes;
};
/// That of each shape; of an opaque one there is none. The box is around all of a shape where so many are
/// near each other that comparing them would take seconds.
[[nodiscard]] std::vector<NearWalls> walls_near_shapes(const Scene& scene);

}  // namespace abbe

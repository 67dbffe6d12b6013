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

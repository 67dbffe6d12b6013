#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// True if a light's emission is positive at some wavelength.
[[nodiscard]] bool emits(const Light& light);

/// A point [m] from which lights are viewed, and the index of the shape that it belongs to, if any.
struct Viewpoint {
  Imath::V3d at;
  std::optional<std::size_t> shape;
};
/// Points from which a scene's lights are viewed.
struct Viewpoints {
  std::vector<Viewpoint> points;  ///< In order of x, so that those near a light are found quickly.
  /// Centers of the scattering shapes, in order of x. A light illuminates them through its own shape and
  /// through shapes around it.
  std::vector<Viewpoint> scattering;
};
/// Centers of the bounding boxes of the scene's specular shapes, and of its scattering ones.
[[nodiscard]] Viewpoints specular_centers(const Scene& scene);
/// The probe's points at `kRepresentativePoints`, without scattering shapes. The camera must be a probe.
[[nodiscard]] Viewpoints probe_viewpoints(const Scene& scene);

/// True if the light subtends less than `limit_sr` [sr] from all viewpoints except its own shape. If there is
/// no other viewpoint, those that scatter count. Delta lights always subtend less, environment lights never;
/// a sun is compared by its own solid angle. A sphere of radius r subtends more than the limit within the
/// distance r/sin of the half angle of a cone of `limit_sr`. A shape that encloses the light is as far as its
/// surface, which transmits the light. It counts only if the light also subtends more than the limit from
/// something that scatters.
[[nodiscard]] bool subtends_less(const Scene& scene, const Light& light, const Viewpoints& from,
                                 double limit_sr);

}  // namespace abbe

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// Whether a light emits anything.
[[nodiscard]] bool emits(const Light& light);

/// The middle of a specular shape.
struct SpecularCenter {
  Imath::V3d at;
  std::size_t shape;
};
/// Those of a scene, in order of x, so that those near a light are found without asking all.
[[nodiscard]] std::vector<SpecularCenter> specular_centers(const Scene& scene);

/// Whether the light looks smaller than `limit_sr` [sr] from every specular shape; delta lights do from
/// anywhere. A ball of radius r looks larger than the limit from nearer than r/sin, the sine being that of
/// half the limit's cone.
[[nodiscard]] bool looks_smaller(const Scene& scene, const Light& light,
                                 std::span<const SpecularCenter> centers, double limit_sr);

}  // namespace abbe

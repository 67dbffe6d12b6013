#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace abbe {

/// Whether a light emits anything.
[[nodiscard]] bool emits(const Light& light);

/// Where lights are looked at from: a shape, or none.
struct Viewpoint {
  Imath::V3d at;
  std::optional<std::size_t> shape;
};
struct Viewpoints {
  std::vector<Viewpoint> places;  ///< In order of x, so that those near a light are found without asking all.
  /// In the same order, the middles of shapes that scatter: they are what a lamp lights through its own shape
  /// and through those around it.
  std::vector<Viewpoint> scattering;
};
/// The middles of a scene's specular shapes.
[[nodiscard]] Viewpoints specular_centers(const Scene& scene);
/// Here and there on the scene's meter.
[[nodiscard]] Viewpoints places_of_meter(const Scene& scene);

/// Whether the light looks smaller than `limit_sr` [sr] from all of the places but its own shape, or, if
/// there is no other, from what scatters; delta lights do from anywhere. A ball of radius r looks larger than
/// the limit from nearer than r/sin, the sine being that of half the limit's cone. A shape that stands around
/// the lamp is as far as its surface, which passes the light on: from there the lamp looks large only if it
/// does from what scatters too.
[[nodiscard]] bool looks_smaller(const Scene& scene, const Light& light, const Viewpoints& from,
                                 double limit_sr);

}  // namespace abbe

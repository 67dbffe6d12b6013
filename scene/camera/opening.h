#pragma once

#include <optional>
#include <variant>

#include <ImathVec.h>

#include "lens/iris.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"

namespace abbe {

/// A planar opening in render coordinates [m]: the points center + a u + b v. A round one has a^2 + b^2 <= 1,
/// otherwise |a|, |b| <= 1. With an iris, (a, b) must also lie inside its polygon.
struct FlatOpening {
  Imath::V3d center;
  Imath::V3d u, v;    ///< Half extents; not parallel, and perpendicular to `normal`.
  Imath::V3d normal;  ///< Unit vector towards the side from which light is received.
  bool round;
  std::optional<lens::Iris> iris = {};
};

/// One side of a sphere, which receives light.
struct SphereSide {
  Sphere sphere;
  bool inwards = false;  ///< True if the sphere receives light from inside, false from outside.
};

/// A surface through which light enters a camera or on which it is received.
using Opening = std::variant<FlatOpening, SphereSide>;

/// Distance > 0 [m] along a light ray, which travels towards the opening, to its intersection with it from
/// the receiving side. Nothing if it misses. The ray's `t_max` is ignored.
[[nodiscard]] std::optional<double> crossing(const Opening& opening, const Ray& ray);
/// Upper bound of the distance [m] of the opening's points from its center.
[[nodiscard]] double opening_radius(const Opening& opening);

}  // namespace abbe

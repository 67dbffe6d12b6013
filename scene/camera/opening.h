#pragma once

#include <optional>
#include <variant>

#include <ImathVec.h>

#include "lens/iris.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"

namespace abbe {

/// A planar opening: the points center + a u + b v. A round one has a^2 + b^2 <= 1, otherwise |a|, |b| <= 1.
/// An iris restricts them to the points that contain (a, b).
struct FlatOpening {
  Imath::V3d center;
  Imath::V3d u, v;    ///< Not parallel.
  Imath::V3d normal;  ///< Outward, unit.
  bool round;
  std::optional<lens::Iris> iris = {};
};

/// One side of a sphere, which receives light from outside or from inside.
struct SphereSide {
  Sphere sphere;
  bool inwards = false;
};

/// A surface through which light enters a camera or on which it is received.
using Opening = std::variant<FlatOpening, SphereSide>;

/// Distance along a ray to its intersection with the opening from the receiving side; nothing if it misses.
[[nodiscard]] std::optional<double> crossing(const Opening& opening, const Ray& ray);
/// Upper bound of the distance [m] of the opening's points from its center.
[[nodiscard]] double opening_radius(const Opening& opening);

}  // namespace abbe

#pragma once

#include <optional>
#include <variant>

#include <ImathVec.h>

#include "lens/iris.h"
#include "scene/shapes/ray.h"
#include "scene/shapes/shape.h"

namespace abbe {

/// The points center + a u + b v, of a round one with a^2 + b^2 <= 1, else with |a|, |b| <= 1; of one with an
/// iris those of them that this has at (a, b).
struct FlatOpening {
  Imath::V3d center;
  Imath::V3d u, v;    ///< Not parallel.
  Imath::V3d normal;  ///< Outward, unit.
  bool round;
  std::optional<lens::Iris> iris = {};
};

/// A side of a sphere, which takes light from without or from within.
struct SphereSide {
  Sphere sphere;
  bool inwards = false;
};

/// What light comes in through, or falls on.
using Opening = std::variant<FlatOpening, SphereSide>;

/// Distance along a ray to where it comes to the opening from the side that takes light; nothing where it
/// does not.
[[nodiscard]] std::optional<double> crossing(const Opening& opening, const Ray& ray);
/// A length that no point of the opening is farther than from its centre.
[[nodiscard]] double extent(const Opening& opening);

}  // namespace abbe

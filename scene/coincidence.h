#pragma once

#include <cstddef>

#include "scene/faces.h"
#include "scene/shapes/shape.h"

namespace abbe {

/// Maximum number of pairs of shapes or faces that a check compares. More pairs would take seconds.
inline constexpr std::size_t kMaxPairs = 50'000'000;

/// True if a face of one shape may coincide with a face of the other, or if the shapes may be tangent:
/// - two faces are parallel, their boxes intersect, and a corner is at most `tolerance` [m] off the other
/// plane;
/// - a sphere is tangent to a face or to another sphere within `tolerance`.
/// It is also true if either shape moves, if ellipsoids are near each other, or if comparing the faces would
/// take seconds.
[[nodiscard]] bool may_coincide(const Shape& a, const Shape& b, double tolerance, FaceFinder& faces);

/// Relative orientation of two coincident faces: arbitrary, or with normals to the same side.
enum class Facing { any, same };

/// True if a face of one shape certainly coincides with a face of the other, or if both are the same sphere.
/// Faces must overlap over an area and have the given orientation:
/// - three corners of either face are at most `tolerance` [m] off the plane of the other face;
/// - the faces overlap by more than `tolerance` in every direction, so adjacent faces do not count;
/// - of two spheres, centers and radii differ by at most `tolerance`.
/// A disc counts as the square inscribed in it. False if either shape moves.
[[nodiscard]] bool overlaps(const Shape& a, const Shape& b, double tolerance, FaceFinder& faces,
                            Facing facing = Facing::any);

/// True if the whole surface of a closed shape certainly lies on another shape. Each of its faces coincides
/// with a face of `body` that faces the same side, or both are one sphere; `tolerance` [m] as in `overlaps`.
/// False if so many faces are near each other that comparing them would take seconds.
[[nodiscard]] bool coats(const Shape& coat, const Shape& body, double tolerance, FaceFinder& faces);

/// True if two faces of one shape coincide, as in `overlaps`. False if so many faces are near each other that
/// comparing them would take seconds.
[[nodiscard]] bool overlaps_itself(const Shape& shape, double tolerance, FaceFinder& faces);

/// True if a point, in render coordinates, lies on a face or sphere that does not move. "On" means so near
/// that floats cannot resolve the side of the point.
[[nodiscard]] bool is_on_surface(const Imath::V3d& point, const Shape& shape, FaceFinder& faces);

}  // namespace abbe

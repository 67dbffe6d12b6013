#pragma once

#include <cstddef>

#include "scene/faces.h"
#include "scene/shapes/shape.h"

namespace abbe {

/// The most pairs of shapes, or of faces, that are compared: more would take seconds.
inline constexpr std::size_t kMostPairs = 50'000'000;

/// Whether a face of one shape may lie in a face of the other: parallel, no further from its plane than
/// `reach` [m], and their boxes meet; or whether a ball touches a face or another ball, around which they are
/// no further apart. It may, too, where either shape moves, where ellipsoids come near each other, or where
/// so many faces meet that comparing them would take seconds.
[[nodiscard]] bool may_coincide(const Shape& a, const Shape& b, double reach, FaceFinder& faces);

/// How faces that lie in each other are turned: either way, or both to the same side.
enum class Facing { any, same };

/// Whether beyond doubt a face of one shape lies in a face of the other, so turned, or a ball in a ball:
/// three corners of either face no further than `reach` [m] from the plane of the other, over more than that
/// each way, or balls the middles and radii of which are no further apart; and neither moves. Faces that are
/// side by side in a plane or meet along an edge do not; of a disc the square within it counts.
[[nodiscard]] bool lies_on(const Shape& a, const Shape& b, double reach, FaceFinder& faces,
                           Facing facing = Facing::any);

/// True if all of a closed shape beyond doubt lies on another: each of its faces in one of the other that is
/// turned to the same side, or a ball in a ball, within the `tolerance` [m] of `lies_on`. False where so many
/// faces are near each other that comparing them would take seconds.
[[nodiscard]] bool coats(const Shape& coat, const Shape& body, double tolerance, FaceFinder& faces);

/// Whether one of a shape's faces so lies in another of its own. None is found where so many are near each
/// other that comparing them would take seconds.
[[nodiscard]] bool lies_on_itself(const Shape& shape, double reach, FaceFinder& faces);

/// Whether a point, in the coordinates of the render, lies in a face or on a ball that does not move, so near
/// that floats do not tell on which side of it.
[[nodiscard]] bool stands_on(const Imath::V3d& point, const Shape& shape, FaceFinder& faces);

}  // namespace abbe

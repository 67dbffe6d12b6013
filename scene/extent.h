#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <ImathBox.h>
#include <ImathVec.h>

#include "scene/camera/camera.h"
#include "scene/shapes/shape.h"

namespace abbe {

struct ShapeInstance;

/// Where the floats of a render are to be finest, and from where on they are not needed to be fine.
///
/// Shapes are taken in the order of their furthest points, seen from the camera. Those before the first gap
/// of a factor `kGap` are near: what reaches further does not decide where the origin is. Of that, what also
/// lies wholly beyond the gap is far; the rest, such as the ground below or a dome above, is large.
struct Extent {
  static constexpr double kGap = 1000;

  Imath::Box3d near;  ///< Around what is near; empty where nothing is, as around a meter of a far lamp.
  /// Where floats are to be finest: the middle of what is near, or the camera where there is none or where it
  /// reaches from the nearest, step by step, more than `kGap` times further.
  Imath::V3d origin{0, 0, 0};
  /// What lies wholly beyond this distance from the camera [m] is far: `kGap` times how far what is near
  /// reaches, a meter's own surface included.
  double far_from = 0;
};
/// Finds what is near, far and large to a camera. To a camera of a lens the shapes it comes to first are
/// near, however far it stands; to a meter, which is lit where it is, only if it sees them larger than
/// 1/`kGap`.
[[nodiscard]] Extent extent_of(const Camera& camera, std::span<const ShapeInstance> shapes);

/// Radius [m] of a scene of these bounds: half their diagonal, 1 of an empty scene, and more than 0.
[[nodiscard]] inline double scene_radius(const Imath::Box3d& bounds) {
  return bounds.isEmpty() ? 1.0 : std::max(bounds.size().length() / 2, 1e-12);
}

/// Distance from a point to the nearest point of a box, 0 within it.
[[nodiscard]] double distance_to(const Imath::Box3d& box, const Imath::V3d& point);

[[nodiscard]] inline double largest_coordinate(const Imath::V3d& point) {
  return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
}
/// 0 of an empty box.
[[nodiscard]] inline double largest_coordinate(const Imath::Box3d& box) {
  return box.isEmpty() ? 0 : std::max(largest_coordinate(box.min), largest_coordinate(box.max));
}

/// A box that reaches so much further to all sides.
[[nodiscard]] inline Imath::Box3d grown(const Imath::Box3d& box, double by) {
  return {box.min - Imath::V3d(by), box.max + Imath::V3d(by)};
}

/// What two boxes have in common; empty where that is nothing.
[[nodiscard]] inline Imath::Box3d common(const Imath::Box3d& a, const Imath::Box3d& b) {
  Imath::Box3d both;
  for (int axis = 0; axis < 3; ++axis) {
    both.min[axis] = std::max(a.min[axis], b.min[axis]);
    both.max[axis] = std::min(a.max[axis], b.max[axis]);
    if (both.min[axis] > both.max[axis]) return {};
  }
  return both;
}

/// How far apart floats of this size are at most.
[[nodiscard]] inline double float_step(double size) {
  return static_cast<double>(std::numeric_limits<float>::epsilon()) * size;
}

}  // namespace abbe

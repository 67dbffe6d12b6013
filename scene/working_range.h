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

/// The region in which the render needs fine float coordinates, and the distance [m] at which that ends. Its
/// coordinates are those of the shapes that it was determined from.
///
/// The shapes are sorted by the distance of their farthest points from the camera. Those before the first gap
/// of a factor `kGap` are near; the others do not influence the choice of origin. Of the others, a shape that
/// lies entirely farther than the gap is distant. The rest, such as the ground or a dome, is large.
struct WorkingRange {
  static constexpr double kGap = 1000;  ///< Ratio of distances.

  /// Box around the near shapes. It is empty if there are none, as for a probe of a distant light.
  Imath::Box3d near;
  /// Position at which floats shall be finest: the center of `near`. It is the camera if nothing is near, or
  /// if `near` extends more than `kGap` times farther than its nearest shape.
  Imath::V3d origin{0, 0, 0};
  /// Shapes farther than this distance from the camera [m] are distant. It is `kGap` times the distance of
  /// the farthest near point, the probe's own surface included.
  double far_threshold = 0;
};
/// Determines which shapes are near, large and distant for a camera. For a camera with a lens the nearest
/// shape in the order of `WorkingRange` is always near, at any distance. For a probe, which is illuminated at
/// its position, the first near shape is the first one whose box has a diagonal of at least 1/`kGap` of the
/// distance of its farthest point. Later shapes before the gap are near, however small they are.
[[nodiscard]] WorkingRange working_range_of(const Camera& camera, std::span<const ShapeInstance> shapes);

/// Radius [m] of a scene with these bounds: half their diagonal, at least 1e-12; 1 for an empty scene.
[[nodiscard]] inline double scene_radius(const Imath::Box3d& bounds) {
  return bounds.isEmpty() ? 1.0 : std::max(bounds.size().length() / 2, 1e-12);
}

/// Distance from a point to the nearest point of a box, which must not be empty; 0 inside.
[[nodiscard]] double distance_to(const Imath::Box3d& box, const Imath::V3d& point);

/// The largest absolute coordinate of a point, which determines the spacing of floats there.
[[nodiscard]] inline double largest_coordinate(const Imath::V3d& point) {
  return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
}
/// The largest absolute coordinate of a box; 0 if it is empty.
[[nodiscard]] inline double largest_coordinate(const Imath::Box3d& box) {
  return box.isEmpty() ? 0 : std::max(largest_coordinate(box.min), largest_coordinate(box.max));
}

/// The box enlarged by `by` on all sides; an empty box stays empty.
[[nodiscard]] inline Imath::Box3d grown(const Imath::Box3d& box, double by) {
  return {box.min - Imath::V3d(by), box.max + Imath::V3d(by)};
}

/// Intersection of two boxes; empty if they are disjoint.
[[nodiscard]] inline Imath::Box3d common(const Imath::Box3d& a, const Imath::Box3d& b) {
  Imath::Box3d both;
  for (int axis = 0; axis < 3; ++axis) {
    both.min[axis] = std::max(a.min[axis], b.min[axis]);
    both.max[axis] = std::min(a.max[axis], b.max[axis]);
    if (both.min[axis] > both.max[axis]) return {};
  }
  return both;
}

/// Upper bound of the spacing of floats of this magnitude, `size` >= 0.
[[nodiscard]] inline double float_step(double size) {
  return static_cast<double>(std::numeric_limits<float>::epsilon()) * size;
}

}  // namespace abbe

#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "scene/shapes/disc.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/quad.h"
#include "scene/shapes/shape.h"
#include "scene/shapes/sphere.h"

namespace abbe {

/// The placement by an invertible affine matrix for row vectors, without motion.
[[nodiscard]] inline Placement placement(const Imath::M44d& to_world) {
  return {to_world, to_world.inverse()};
}

/// The placement at `time`, a fraction of the exposure in [0, 1]. The result does not move.
[[nodiscard]] inline Placement placement_at(const Placement& placement, double time) {
  if (!placement.motion) return placement;
  const Imath::M44d since_opening = placement.motion->since_opening(time);
  return {placement.to_world * since_opening, rigid_inverse(since_opening) * placement.to_prototype, nullptr,
          placement.described_origin};
}

/// The ray in the prototype's coordinates. Its direction is not normalised, so that t is the same in both
/// coordinate systems.
template <typename T>
[[nodiscard]] BasicRay<T> to_prototype(const Placement& placement, const BasicRay<T>& ray) {
  const Imath::Matrix44<T> map(placement.to_prototype);
  BasicRay<T> moved{ray.origin * map, {}, ray.t_max};
  map.multDirMatrix(ray.direction, moved.direction);
  return moved;
}

/// The ray, at its time, in the coordinates in which the scene file describes the shape, minus
/// `Scene::origin_m`. For an instance of an object these are the object's coordinates. For any other shape
/// they are the scene's coordinates, without the motion of the shape. A shape that is no `PlacedShape`
/// returns the ray unchanged. The ray's t is the distance in the world.
[[nodiscard]] inline BasicRay<double> to_description(const Shape& shape, const BasicRay<double>& ray) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  if (placed == nullptr) return ray;
  BasicRay<double> described = to_prototype(placement_at(*placed->at, static_cast<double>(ray.time)), ray);
  described.origin += placed->at->described_origin;
  return described;
}

/// World normal of a prototype's normal, by the inverse transpose. It keeps outward normals outward whatever
/// the handedness of the map. Unit length.
template <typename T>
[[nodiscard]] Imath::Vec3<T> normal_to_world(const Placement& placement, const Imath::Vec3<T>& normal) {
  Imath::Vec3<T> moved;
  Imath::Matrix44<T>(placement.to_prototype).transposed().multDirMatrix(normal, moved);
  return moved.normalized();
}

/// Nearest hit with an instance of a shape at t in (`t_min`, ray.t_max), in world coordinates. The placement
/// is used as it is, without its motion.
template <typename T, typename S>
[[nodiscard]] std::optional<ShapeHit<T>> intersect_placed(const S& shape, const Placement& placement,
                                                          const BasicRay<T>& ray, T t_min) {
  const auto hit = intersect(shape, to_prototype(placement, ray), t_min);
  if (!hit) return std::nullopt;
  return ShapeHit<T>{hit->t, hit->point * Imath::Matrix44<T>(placement.to_world),
                     normal_to_world(placement, hit->normal)};
}

/// True if the ray, up to its `t_max`, passes through the box or within rounding of it. Rounding never makes
/// it false for a ray that hits the box.
template <typename T>
[[nodiscard]] bool passes(const BasicRay<T>& ray, const Imath::Box3d& box) {
  const Imath::V3d origin(ray.origin);
  const double slack = 64 * static_cast<double>(std::numeric_limits<T>::epsilon()) *
                       (box.size().length() + box.center().length() + origin.length());
  double near = 0;
  double far = static_cast<double>(ray.t_max);
  for (int i = 0; i < 3; ++i) {
    const double step = static_cast<double>(ray.direction[i]);
    double enter = (box.min[i] - slack - origin[i]) / step;
    double leave = (box.max[i] + slack - origin[i]) / step;
    if (enter > leave) std::swap(enter, leave);
    near = std::max(near, enter);  // NaN, for a ray in the plane of a face, has no effect
    far = std::min(far, leave);
  }
  return near <= far * (1 + 1e-9);
}

/// Nearest hit with an instance at t in (`t_min`, ray.t_max), with its pose at the ray's time.
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const PlacedShape& placed, const BasicRay<T>& ray,
                                                   T t_min) {
  if (placed.at->motion) {
    const auto now =
        std::make_shared<const Placement>(placement_at(*placed.at, static_cast<double>(ray.time)));
    return intersect(PlacedShape{placed.of, now}, ray, t_min);
  }
  if (!passes(to_prototype(*placed.at, ray), placed.of->bounds)) return std::nullopt;
  return std::visit([&](const auto& shape) { return intersect_placed(shape, *placed.at, ray, t_min); },
                    placed.of->shape);
}

/// World positions at time 0 of the eight corners of the prototype's box.
[[nodiscard]] inline std::vector<Imath::V3d> corners(const Prototype& prototype, const Placement& placement) {
  const std::array<Imath::V3d, 2> ends{prototype.bounds.min, prototype.bounds.max};
  std::vector<Imath::V3d> points;
  for (const auto& x : ends)
    for (const auto& y : ends)
      for (const auto& z : ends) points.push_back(Imath::V3d(x.x, y.y, z.z) * placement.to_world);
  return points;
}

/// World box around an instance during the whole exposure.
[[nodiscard]] inline Imath::Box3d bounds(const PlacedShape& placed) {
  const std::vector<Imath::V3d> points = corners(*placed.of, *placed.at);
  if (placed.at->motion) return placed.at->motion->sweep(points, 0, 1);
  Imath::Box3d box;
  for (const Imath::V3d& point : points) box.extendBy(point);
  return box;
}

}  // namespace abbe

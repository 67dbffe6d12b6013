#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImathVec.h>

#include "scene/shapes/basic.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/model.h"
#include "scene/shapes/motion.h"
#include "scene/shapes/quadric.h"

namespace abbe {

/// A variant with the alternatives of several others.
template <typename... Variants>
struct Joined;
template <typename... All>
struct Joined<std::variant<All...>> {
  using type = std::variant<All...>;
};
template <typename... First, typename... Second, typename... Others>
struct Joined<std::variant<First...>, std::variant<Second...>, Others...>
    : Joined<std::variant<First..., Second...>, Others...> {};

/// Shapes that are rendered as triangles with float vertices: `triangles_of` without their normals.
/// `normal_at` is the outward unit normal of one triangle, from the unrounded vertices.
using TriangulatedShape = std::variant<Mesh, Quad>;
template <typename S>
concept Triangulated = requires(const S& shape) {
  triangles_of(shape);
  normal_at(shape, std::size_t{});
};
/// Shapes whose own formula in double precision decides where a ray hits them.
using CurvedShape = std::variant<Sphere, Disc, Quadric>;
/// The closed list of shapes that are not instances.
using PlainShape = Joined<TriangulatedShape, CurvedShape>::type;

/// Functions that each shape implements, with exactly these signatures. A plain call would not check the
/// first ones, because a shape converts implicitly to `Shape`, whose function would be found instead. Only
/// meshes are sampled by a table.
template <typename S>
concept SampledByArea = std::same_as<S, Mesh> || requires {
  static_cast<SurfacePoint (*)(const S&, Imath::V2f)>(sample_area);
};
template <typename S>
concept ShapeModel = SampledByArea<S> && requires(const S& shape) {
  static_cast<std::optional<ShapeHit<float>> (*)(const S&, const BasicRay<float>&, float)>(intersect);
  static_cast<std::optional<ShapeHit<double>> (*)(const S&, const BasicRay<double>&, double)>(intersect);
  static_cast<Imath::Box3d (*)(const S&)>(bounds);
  static_cast<double (*)(const S&)>(area);
  static_cast<SurfaceCoordinates (*)(const S&, const Imath::V3d&, std::size_t)>(coordinates_on);
  static_cast<Outline (*)(const S&, const Imath::M44d&, const DrawingPlane&)>(outline);
  static_cast<void (*)(S&, const Imath::V3d&)>(shift);
  static_cast<void (*)(S&, const Imath::M44d&, double)>(transform);
  // with defaults:
  { enclosed_volume(shape) } -> std::same_as<double>;
  { may_intersect(shape, Imath::Box3d()) } -> std::same_as<bool>;
  { flat_face(shape) } -> std::same_as<std::optional<FlatFace>>;
  { ball_of(shape) } -> std::same_as<std::optional<Ball>>;
  { thickness(shape) } -> std::same_as<double>;
  { outer_side(shape) } -> std::same_as<OuterSide>;
};
template <typename List>
constexpr bool kAllShapeModels = false;
template <typename... Shapes>
constexpr bool kAllShapeModels<std::variant<Shapes...>> = (ShapeModel<Shapes> && ...);
static_assert(kAllShapeModels<PlainShape>);

/// The shape that instances share, in its own coordinates, and its bounding box.
struct Prototype {
  PlainShape shape;
  Imath::Box3d bounds;
};
[[nodiscard]] std::shared_ptr<const Prototype> make_prototype(PlainShape shape);
/// An invertible affine map between a prototype's coordinates and the world, for row vectors. It may mirror;
/// normals stay outward. The maps of a moving shape are those of time 0, and `placement_at` gives the others.
struct Placement {
  Imath::M44d to_world;
  Imath::M44d to_prototype;
  std::shared_ptr<const Motion> motion = nullptr;  ///< Present if the shape moves.
  /// Position of the prototype's origin in the coordinates in which the scene file describes the shape,
  /// recentred as the scene is. These are the coordinates of the scene or of an object.
  Imath::V3d described_origin{0, 0, 0};
};
/// One instance: a prototype and its placement. Moving shapes are instances too.
struct PlacedShape {
  std::shared_ptr<const Prototype> of;
  std::shared_ptr<const Placement> at;
};

/// Any shape. Each kind computes its nearest hit in float or double.
using Shape = Joined<PlainShape, std::variant<PlacedShape>>::type;

/// The shape, or the prototype of an instance, if it is an S; otherwise nullptr.
template <typename S>
[[nodiscard]] const S* plain(const Shape& shape) {
  if (const auto* placed = std::get_if<PlacedShape>(&shape)) return std::get_if<S>(&placed->of->shape);
  return std::get_if<S>(&shape);
}

/// Calls `visitor` with the plain shape, or with the prototype of an instance in its own coordinates.
template <typename Visitor>
auto visit_plain(const Visitor& visitor, const Shape& shape) {
  return std::visit(
      [&visitor](const auto& s) {
        if constexpr (std::is_same_v<std::decay_t<decltype(s)>, PlacedShape>)
          return std::visit(visitor, s.of->shape);
        else
          return visitor(s);
      },
      shape);
}
/// True if the shape, or the prototype of an instance, is rendered as triangles.
[[nodiscard]] inline bool is_triangulated(const Shape& shape) {
  return visit_plain([](const auto& s) { return Triangulated<std::decay_t<decltype(s)>>; }, shape);
}

/// The face of a flat shape, or of the prototype of an instance in its own coordinates; nothing for others.
[[nodiscard]] inline std::optional<FlatFace> flat_face(const Shape& shape) {
  return visit_plain([](const auto& s) { return flat_face(s); }, shape);
}
[[nodiscard]] inline bool is_flat(const Shape& shape) {
  return flat_face(shape).has_value();
}
/// The ball of a sphere, or of the prototype of an instance in its own coordinates; nothing for others.
[[nodiscard]] inline std::optional<Ball> ball_of(const Shape& shape) {
  return visit_plain([](const auto& s) { return ball_of(s); }, shape);
}
/// True if the shape, or the prototype of an instance, consists of flat faces, as meshes do too.
[[nodiscard]] inline bool has_faces(const Shape& shape) {
  return plain<Mesh>(shape) != nullptr || is_flat(shape);
}

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
  return {ray.origin * map, moved_direction(ray.direction, map), ray.t_max};
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
  return moved_direction(normal, Imath::Matrix44<T>(placement.to_prototype).transposed()).normalized();
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

/// Nearest hit at t in (t_min, ray.t_max); nothing if the ray misses. `ray.direction` may have any length; t
/// is in units of that length. A moving shape is that at the ray's time. T is float or double.
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Shape& shape, const BasicRay<T>& ray, T t_min);

/// Does nothing: instances may have a placement in common, and each placement is translated once elsewhere.
inline void shift(PlacedShape& /*placed*/, const Imath::V3d& /*by*/) {}

/// Motion of the shape; nullptr if it does not move.
[[nodiscard]] inline const Motion* motion_of(const Shape& shape) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  return placed != nullptr ? placed->at->motion.get() : nullptr;
}

/// Bounding box of the shape; for an instance that of its prototype's box, for a moving shape that over all
/// times.
[[nodiscard]] Imath::Box3d bounds(const Shape& shape);
/// True if the surface of a static shape may intersect the box. False if their bounding boxes are separate,
/// and if the box lies entirely inside a sphere, or touches no triangle's bounding box in a mesh. Instances
/// are tested by their bounding box alone.
[[nodiscard]] bool may_intersect(const Shape& shape, const Imath::Box3d& box);
/// Area of the outer side of a shape [m^2]. Throws Error{internal} for static instances, which do not emit.
[[nodiscard]] double area(const Shape& shape);

/// Samples a point of the shape by two random numbers in [0, 1); for a moving shape in its prototype's
/// coordinates. `triangle_cdf` is the result of the function below for the shape. Throws Error{internal} for
/// static instances.
[[nodiscard]] SurfacePoint sample_area(const Shape& shape, const std::vector<float>& triangle_cdf,
                                       Imath::V2f u);

/// Cumulative fraction of the area over the triangles of a mesh, ending in 1; empty for other shapes.
[[nodiscard]] std::vector<float> triangle_cdf(const Shape& shape);
/// The outer side of a shape as a light; a moving shape faces all directions. Throws Error{internal} for
/// static instances.
[[nodiscard]] OuterSide outer_side(const Shape& shape);
/// Outward unit normal of a triangle of a mesh or quad, from the unrounded vertices. Other shapes are not
/// allowed.
[[nodiscard]] Imath::V3d triangle_normal(const PlainShape& shape, std::size_t triangle);
/// Outline of a shape viewed from far away, at time 0: the circumference of spheres and discs, the edges of
/// quads, rims and two meridians of quadrics, and the creases of meshes. Creases are edges of one triangle,
/// or of two whose normals differ by more than one degree. A mesh of more than 4000 triangles is replaced by
/// the rectangle around its bounding box in the drawing.
[[nodiscard]] Outline outline(const Shape& shape, const DrawingPlane& plane);

/// Texture coordinates of a point [m] on the shape; `triangle` is the index of its triangle in a mesh and has
/// no effect on other shapes. u runs to the right and v upwards in the picture. Pictures appear upright and
/// not mirrored from outside:
/// - quad: u and v run along its edges;
/// - disc: the square around it is [0, 1]^2. v runs along the projection of +z, or of +y if the normal is
/// within 26 degrees of z. u is perpendicular to both, to the right as seen from the front;
/// - sphere: u is the longitude from +x over +y divided by 2 pi; v is 0 at the pole at -z and 1 at the pole
/// at +z;
/// - quadric: u is the azimuth around its axis divided by 2 pi, counted from x of `Basis`; v is 0 at its
/// lower end and 1 at the upper one. On caps v is the distance from the axis divided by the cap's radius;
/// - mesh: the coordinates of its file, interpolated over each triangle; for a prism those of `make_prism`.
/// An instance has the coordinates of its prototype. A moving shape is evaluated at `time`, a fraction of
/// the exposure.
[[nodiscard]] SurfaceCoordinates coordinates(const Shape& shape, const Imath::V3d& point,
                                             std::size_t triangle, float time);

/// Unit normal interpolated from the vertex normals of a mesh over triangle number `triangle`, at that time.
/// It is flipped to the side of the `geometric` normal, the outward unit normal, if necessary. Where it is
/// perpendicular to that normal, the result is `geometric`. Nothing for a shape without vertex normals.
[[nodiscard]] std::optional<Imath::V3d> interpolated_normal(const Shape& shape, const Imath::V3d& point,
                                                            std::size_t triangle, const Imath::V3d& geometric,
                                                            float time);

/// A shape with its material, and its light if it emits.
struct ShapeInstance {
  std::string name;
  Shape shape;
  std::uint32_t material;   ///< Index into `Scene::materials`.
  std::int32_t light = -1;  ///< Index into `Scene::lights`, or -1.
  // Set by `Scene::commit`:
  bool distant = false;  ///< Entirely farther than `Scene::far_threshold_m`.
  double rounding = 0;   ///< Largest absolute coordinate of its float vertices [m]; 0 for curved shapes.
  /// Volume of the enclosed medium [m^3], see `enclosed_volume`; 0 if no other shape encloses a medium.
  double volume = 0;
  /// Region [m] where it transmits light and an opaque surface is within float resolution; empty if there is
  /// none.
  Imath::Box3f near_wall_bounds = {};
  /// Region [m] where another surface may coincide with it, by `coincidence_regions`; empty if there is none.
  /// Nothing if that was not examined, so that a surface may coincide anywhere.
  std::optional<Imath::Box3f> coincidence_bounds = {};
};

}  // namespace abbe

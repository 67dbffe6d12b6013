#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImathVec.h>

#include "scene/shapes/motion.h"
#include "scene/shapes/ray.h"

namespace abbe {

/// The intersection of a ray and a shape. The normal is the outward geometric unit normal, whatever the ray's
/// direction.
template <typename T>
struct ShapeHit {
  T t;  ///< In units of the ray's direction.
  Imath::Vec3<T> point;
  Imath::Vec3<T> normal;
};

/// Triangles with shared vertices [m]. The winding determines the normals: counter-clockwise as viewed from
/// outside. Prisms become meshes too.
struct Mesh {
  std::vector<Imath::V3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices of vertices; nonzero area.
  /// Texture coordinates of the corners of each triangle; none, or as many as triangles.
  std::vector<std::array<Imath::V2f, 3>> coordinates = {};
  /// Unit vertex normals of each triangle: the normals of the smooth surface that it approximates. None, or
  /// as many as triangles.
  std::vector<std::array<Imath::V3f, 3>> normals = {};
  /// Triangles of zero area. No ray hits them, but adjacent triangles are connected through them.
  std::vector<std::array<std::uint32_t, 3>> slivers = {};
};
/// A sphere [m]; its normal points away from the center.
struct Sphere {
  Imath::V3d center;
  double radius;
};
/// A flat disc [m]; its outer side is that of `normal`, which has unit length.
struct Disc {
  Imath::V3d center;
  Imath::V3d normal;
  double radius;
};
/// A parallelogram [m]: corner + u edge_u + v edge_v for u and v in [0, 1], outward normal along edge_u x
/// edge_v.
struct Quad {
  Imath::V3d corner;
  Imath::V3d edge_u;
  Imath::V3d edge_v;
};

/// The closed list of shapes that are not instances. Each has its formulas in a file of its name.
using PlainShape = std::variant<Mesh, Sphere, Disc, Quad>;

/// The shape that instances share, in its own coordinates, and its bounding box.
struct Prototype {
  PlainShape shape;
  Imath::Box3d bounds;
};
/// The prototype of a shape, with its bounding box.
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
using Shape = std::variant<Mesh, Sphere, Disc, Quad, PlacedShape>;

/// The shape, or the prototype of an instance, if it is an S; otherwise nullptr.
template <typename S>
[[nodiscard]] const S* plain(const Shape& shape) {
  if (const auto* placed = std::get_if<PlacedShape>(&shape)) return std::get_if<S>(&placed->of->shape);
  return std::get_if<S>(&shape);
}

/// Nearest hit at t in (t_min, ray.t_max); nothing if the ray misses. `ray.direction` may have any length; t
/// is in units of that length. A moving shape is that at the ray's time. T is float or double.
template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Shape& shape, const BasicRay<T>& ray, T t_min);

/// Motion of the shape; nullptr if it does not move.
[[nodiscard]] inline const Motion* motion_of(const Shape& shape) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  return placed != nullptr ? placed->at->motion.get() : nullptr;
}

/// A right prism with an isosceles cross-section. The apex angle [degrees], in (0, 180), is between its two
/// equal faces of width `side`. The apex edge points to +z, the third face is a plane z = const, and the
/// edges of length `length` run along y. The origin is the centroid. On the three faces the texture
/// coordinate u runs along the length and v around the prism, each from 0 to 1. On the ends they are
/// fractions of the cross-section's box.
[[nodiscard]] Mesh make_prism(double apex_deg, double side, double length);

/// Bounding box of the shape; for an instance that of its prototype's box, for a moving shape that over all
/// times.
[[nodiscard]] Imath::Box3d bounds(const Shape& shape);
/// True if the surface of a static shape may intersect the box. False if their bounding boxes are separate,
/// and if the box lies entirely inside a sphere, or touches no triangle's bounding box in a mesh. Instances
/// are tested by their bounding box alone.
[[nodiscard]] bool may_intersect(const Shape& shape, const Imath::Box3d& box);
/// Area of the outer side of a shape [m^2]. Throws Error{internal} for static instances, which do not emit.
[[nodiscard]] double area(const Shape& shape);

/// A point sampled uniformly by area on the surface as rendered: with corners rounded to float, and exact
/// curved surfaces.
struct SurfacePoint {
  Imath::V3f point;
  Imath::V3f normal;
};
/// Samples a point of the shape by two random numbers in [0, 1); for a moving shape in its prototype's
/// coordinates. `triangle_cdf` is the result of the function below for the shape. Throws Error{internal} for
/// static instances.
[[nodiscard]] SurfacePoint sample_area(const Shape& shape, const std::vector<float>& triangle_cdf,
                                       Imath::V2f u);

/// Cumulative fraction of the area over the triangles of a mesh, ending in 1; empty for other shapes.
[[nodiscard]] std::vector<float> triangle_cdf(const Shape& shape);

}  // namespace abbe

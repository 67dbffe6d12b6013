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

/// Where a ray meets a shape. The normal is geometric, of unit length, pointing outward.
template <typename T>
struct ShapeHit {
  T t;
  Imath::Vec3<T> point;
  Imath::Vec3<T> normal;
};

/// Triangles with shared vertices, normals by winding (counter-clockwise seen from outside). Prisms become
/// meshes too.
struct Mesh {
  std::vector<Imath::V3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Texture coordinates of the corners of each triangle; none, or as many as triangles.
  std::vector<std::array<Imath::V2f, 3>> coordinates = {};
  /// Unit normals at the corners of each triangle: what a smooth surface would have there, of which the
  /// triangle is a piece. None, or as many as triangles.
  std::vector<std::array<Imath::V3f, 3>> normals = {};
  /// Triangles of no area: nothing meets them, but those beside them meet along their edges.
  std::vector<std::array<std::uint32_t, 3>> slivers = {};
};
struct Sphere {
  Imath::V3d center;
  double radius;
};
/// The normal is of unit length.
struct Disc {
  Imath::V3d center;
  Imath::V3d normal;
  double radius;
};
/// A parallelogram: corner + u edge_u + v edge_v, normal along edge_u x edge_v.
struct Quad {
  Imath::V3d corner;
  Imath::V3d edge_u;
  Imath::V3d edge_v;
};

/// The closed list of shapes that stand by themselves, each with its formulas in a file of its name.
using PlainShape = std::variant<Mesh, Sphere, Disc, Quad>;

/// What all instances of a shape share: the shape in coordinates of its own, and the box around it.
struct Prototype {
  PlainShape shape;
  Imath::Box3d bounds;
};
[[nodiscard]] std::shared_ptr<const Prototype> make_prototype(PlainShape shape);
/// An invertible affine map between a prototype's coordinates and the world, for row vectors. A mirror is one
/// too: normals stay outward. Of what moves, the maps are those of time 0, and `placement_at` tells others.
struct Placement {
  Imath::M44d to_world;
  Imath::M44d to_prototype;
  std::shared_ptr<const Motion> motion = nullptr;  ///< Of what moves.
  /// Position of the prototype's origin in the coordinates that the scene file describes the shape in, those
  /// of the scene or of an object, recentred as the scene is.
  Imath::V3d described_origin{0, 0, 0};
};
/// One instance: a prototype, and where it stands. A shape that moves is one too.
struct PlacedShape {
  std::shared_ptr<const Prototype> of;
  std::shared_ptr<const Placement> at;
};

/// Each shape gives its nearest hit at t in (t_min, ray.t_max) by its own code in the scalar asked for, float
/// or double; `ray.direction` may have any length, and t counts in that length.
using Shape = std::variant<Mesh, Sphere, Disc, Quad, PlacedShape>;

/// The shape, or what it is an instance of, if that is an S; else nullptr.
template <typename S>
[[nodiscard]] const S* plain(const Shape& shape) {
  if (const auto* placed = std::get_if<PlacedShape>(&shape)) return std::get_if<S>(&placed->of->shape);
  return std::get_if<S>(&shape);
}

template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Shape& shape, const BasicRay<T>& ray, T t_min);

/// How the shape moves; nullptr of one that stands still.
[[nodiscard]] inline const Motion* motion_of(const Shape& shape) {
  const auto* placed = std::get_if<PlacedShape>(&shape);
  return placed != nullptr ? placed->at->motion.get() : nullptr;
}

/// A right prism with an isosceles cross-section: apex angle [degrees] in (0, 180) between its two equal
/// faces of width `side`. The apex edge is towards +z, the third face lies in a plane z = const, the edges of
/// length `length` run along y. The origin is the centroid. On the three faces the texture coordinate u runs
/// along the length and v around it, 0 to 1 on each; on the ends they are shares of the cross-section.
[[nodiscard]] Mesh make_prism(double apex_deg, double side, double length);

/// A box around the shape; of an instance, that around its prototype's box. Of a shape that moves, it holds
/// the shape at all times.
[[nodiscard]] Imath::Box3d bounds(const Shape& shape);
/// Whether the surface of a shape that stands still may meet the box: no box that it is far from or that lies
/// wholly within a sphere, or within a mesh and away from its triangles.
[[nodiscard]] bool may_meet(const Shape& shape, const Imath::Box3d& box);
/// Area of the outer side of a shape [m^2]. Instances that stand still do not emit and have no use for it:
/// Error{internal}, here and below.
[[nodiscard]] double area(const Shape& shape);

/// A point drawn uniformly by area, on the surface as the render holds it: corners rounded to float, curves
/// exact.
struct SurfacePoint {
  Imath::V3f point;
  Imath::V3f normal;
};
/// Draws a point of the shape by two numbers in [0, 1), of one that moves in its prototype's coordinates;
/// `triangle_cdf` is what the function below makes of the shape.
[[nodiscard]] SurfacePoint sample_area(const Shape& shape, const std::vector<float>& triangle_cdf,
                                       Imath::V2f u);

/// Cumulative share of the area over the triangles of a mesh, ending in 1; empty for other shapes.
[[nodiscard]] std::vector<float> triangle_cdf(const Shape& shape);

}  // namespace abbe

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include <ImathBox.h>
#include <ImathVec.h>

#include "scene/ray.h"

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

/// The closed list of shapes, each with its formulas in a file of its name. Each gives its nearest hit at t
/// in (t_min, ray.t_max) by its own code in the scalar asked for, float or double; `ray.direction` may have
/// any length, and t counts in that length.
using Shape = std::variant<Mesh, Sphere, Disc, Quad>;

template <typename T>
[[nodiscard]] std::optional<ShapeHit<T>> intersect(const Shape& shape, const BasicRay<T>& ray, T t_min);

/// A right prism with an isosceles cross-section: apex angle [degrees] in (0, 180) between its two equal
/// faces of width `side`. The apex edge is towards +z, the third face lies in a plane z = const, the edges of
/// length `length` run along y. The origin is the centroid.
[[nodiscard]] Mesh make_prism(double apex_deg, double side, double length);

[[nodiscard]] double area(const Shape& shape);  ///< Of the outer side [m^2].
[[nodiscard]] Imath::Box3d bounds(const Shape& shape);

/// A point drawn uniformly by area, on the surface as the render holds it: corners rounded to float, curves
/// exact.
struct SurfacePoint {
  Imath::V3f point;
  Imath::V3f normal;
};
/// `triangle_cdf` is that of the shape, from the function below.
[[nodiscard]] SurfacePoint sample_area(const Shape& shape, const std::vector<float>& triangle_cdf,
                                       Imath::V2f u);

/// Cumulative share of the area over the triangles of a mesh, ending in 1; empty for other shapes.
[[nodiscard]] std::vector<float> triangle_cdf(const Shape& shape);

}  // namespace abbe

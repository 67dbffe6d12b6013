#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImathVec.h>

#include "scene/shapes/ray.h"

namespace abbe {

// A shape answers the questions of the rest of the program, which `ShapeModel` lists. Its functions are in
// the header of its struct. Lengths are in metres.

/// The intersection of a ray and a shape. The normal is the outward geometric unit normal, whatever the ray's
/// direction.
template <typename T>
struct ShapeHit {
  T t;  ///< In units of the ray's direction.
  Imath::Vec3<T> point;
  Imath::Vec3<T> normal;
};

/// A point sampled uniformly by area on the surface as rendered: with corners rounded to float, and exact
/// curved surfaces.
struct SurfacePoint {
  Imath::V3f point;
  Imath::V3f normal;
};

/// Texture coordinates of a point and the derivatives of the position [m] in render coordinates. `dp_du` and
/// `dp_dv` are zero where they are undefined: at the poles of a sphere, and on triangles whose corners have
/// equal coordinates or none.
struct SurfaceCoordinates {
  Imath::V2d uv{0, 0};
  Imath::V3d dp_du{0, 0, 0};
  Imath::V3d dp_dv{0, 0, 0};
};

/// A ball [m].
struct Ball {
  Imath::V3d center;
  double radius;
};

/// A flat shape: a parallelogram, or the disc inscribed in a square.
struct FlatFace {
  Imath::V3d corner, edge_u, edge_v;
  Imath::V3d center;
  Imath::V3d normal;   ///< Outward unit normal.
  bool round = false;  ///< True if the shape is the inscribed disc.
};

/// Triangles that represent a shape, in float as Embree uses them, in the coordinates of the shape [m].
struct TriangleSet {
  std::vector<Imath::V3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Outward unit normals, one per triangle, from the unrounded vertices; empty in a prototype.
  std::vector<Imath::V3f> normals;
  bool is_quad = false;  ///< True if the two triangles are halves of a parallelogram.
};

/// A cone that contains the outward normals of a shape.
struct NormalCone {
  Imath::V3d axis;  ///< Unit vector.
  double spread;    ///< Largest angle to the axis [radians].
};
/// The outer side of a shape as a light that shines from afar.
struct OuterSide {
  double projected_area;              ///< Upper bound or typical value of its projected area [m^2].
  std::optional<NormalCone> normals;  ///< Nothing if it faces all directions.
};

/// Coordinates of a vector in a plane, with respect to two edges that span it.
struct PlaneCoordinates {
  double first;
  double second;

  PlaneCoordinates(const Imath::V3d& vector, const Imath::V3d& edge_a, const Imath::V3d& edge_b) {
    const Imath::V3d normal = edge_a.cross(edge_b);
    first = vector.cross(edge_b).dot(normal) / normal.length2();
    second = edge_a.cross(vector).dot(normal) / normal.length2();
  }
};
/// A direction under the linear part of a matrix for row vectors.
template <typename T>
[[nodiscard]] Imath::Vec3<T> moved_direction(const Imath::Vec3<T>& v, const Imath::Matrix44<T>& by) {
  Imath::Vec3<T> result;
  by.multDirMatrix(v, result);
  return result;
}

/// Viewing direction of a drawing, given by the perpendicular unit vectors that point right and up in it.
struct DrawingPlane {
  Imath::V3d right;
  Imath::V3d up;
};
/// Polylines in space [m]. Closed lines repeat their first point.
using Outline = std::vector<std::vector<Imath::V3d>>;

/// The point number `i` of 64 around a unit circle in drawings, as its angle [radians].
inline constexpr int kOutlineCorners = 64;
[[nodiscard]] inline double outline_angle(int i) {
  return 2 * std::numbers::pi * i / kOutlineCorners;
}

// The answers of most shapes. A shape overloads those that differ.

/// Volume [m^3] that the shape encloses; 0 if it encloses nothing.
template <typename S>
[[nodiscard]] double enclosed_volume(const S& /*shape*/) {
  return 0;
}
/// True if the surface may intersect a box that intersects the shape's bounding box.
template <typename S>
[[nodiscard]] bool may_intersect(const S& /*shape*/, const Imath::Box3d& /*box*/) {
  return true;
}
/// The face of a flat shape; nothing for other shapes.
template <typename S>
[[nodiscard]] std::optional<FlatFace> flat_face(const S& /*shape*/) {
  return std::nullopt;
}
/// The ball whose surface the shape is; nothing for other shapes.
template <typename S>
[[nodiscard]] std::optional<Ball> ball_of(const S& /*shape*/) {
  return std::nullopt;
}
/// Lower bound of the distance [m] between two parts of the surface that face opposite directions. It has no
/// effect on flat shapes and meshes, whose faces are compared instead.
template <typename S>
[[nodiscard]] double thickness(const S& /*shape*/) {
  return 0;
}
/// The outer side of the shape as a light.
template <typename S>
[[nodiscard]] OuterSide outer_side(const S& shape) {
  return {area(shape), std::nullopt};
}

}  // namespace abbe

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <ImathVec.h>

#include "description/load_context.h"
#include "io/schema/fields.h"
#include "scene/shapes/shape.h"

namespace abbe::spec {

// Surfaces as scene files describe them. Lengths and positions are in the scene file's unit, before any
// transform.

/// A sphere, whose front is outside.
struct Sphere {
  Imath::V3d center{0, 0, 0};
  double radius = 0;
};
/// A flat disc.
struct Disc {
  Imath::V3d center{0, 0, 0};
  Imath::V3d normal{0, 0, 0};  ///< Direction of the front, of any length except 0.
  double radius = 0;
};
/// A parallelogram, whose front faces edge_u x edge_v.
struct Quad {
  Imath::V3d corner{0, 0, 0};
  Imath::V3d edge_u{0, 0, 0};
  Imath::V3d edge_v{0, 0, 0};
  SourcePosition where;
};
/// The curved surface of a cylinder, whose front is outside.
struct Cylinder {
  Imath::V3d from{0, 0, 0};  ///< Center of one end.
  Imath::V3d to{0, 0, 0};    ///< Center of the other end.
  double radius = 0;
  bool caps = false;  ///< True if discs close both ends.
  SourcePosition where;
};
/// The curved surface of a cone, whose front is outside.
struct Cone {
  Imath::V3d base{0, 0, 0};  ///< Center of the base.
  Imath::V3d apex{0, 0, 0};
  double radius = 0;  ///< Radius of the base.
  bool caps = false;  ///< True if a disc closes the base.
  SourcePosition where;
};
/// A paraboloid, whose front is the convex side.
struct Paraboloid {
  Imath::V3d vertex{0, 0, 0};
  Imath::V3d axis{0, 0, 0};  ///< Direction from the vertex to the focus, of any length except 0.
  double focal_length = 0;   ///< Distance from the vertex to the focus.
  double radius = 0;         ///< Radius of the rim.
};
/// A right prism along y around the origin, with an isosceles cross-section whose apex points along +z.
struct Prism {
  double apex_deg = 0;  ///< Angle between the two equal faces, in (0, 180).
  double side = 0;      ///< Width of the equal faces.
  double length = 0;    ///< Length along y.
};
/// Triangles given in the scene file itself.
struct InlineMesh {
  std::vector<std::array<double, 3>> vertices;  ///< Positions.
  /// Indices of the vertices of each triangle, counted from 0; counter-clockwise if viewed from the front.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Texture coordinates of each vertex; none if absent. v increases upwards on images.
  std::optional<schema::Located<std::vector<std::array<double, 2>>>> uv;
  SourcePosition where;
};
// Key tables and forms by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Sphere>);
[[nodiscard]] schema::Fields fields(schema::Tag<Disc>);
[[nodiscard]] schema::Fields fields(schema::Tag<Quad>);
[[nodiscard]] schema::Fields fields(schema::Tag<Cylinder>);
[[nodiscard]] schema::Fields fields(schema::Tag<Cone>);
[[nodiscard]] schema::Fields fields(schema::Tag<Paraboloid>);
[[nodiscard]] schema::Fields fields(schema::Tag<Prism>);
[[nodiscard]] schema::Fields fields(schema::Tag<InlineMesh>);

}  // namespace abbe::spec

namespace abbe::description {

// Each `build` returns the surface in metres, before its transform. Errors go to `context.diagnostics`.

[[nodiscard]] Sphere build(const spec::Sphere& sphere, const LoadContext& context);
[[nodiscard]] Disc build(const spec::Disc& disc, const LoadContext& context);
/// Reports parallel edges at `quad.where` and returns nothing then.
[[nodiscard]] std::optional<Quad> build(const spec::Quad& quad, const LoadContext& context);
/// Both report ends at the same position at `where` and return nothing then.
[[nodiscard]] std::optional<Quadric> build(const spec::Cylinder& cylinder, const LoadContext& context);
[[nodiscard]] std::optional<Quadric> build(const spec::Cone& cone, const LoadContext& context);
[[nodiscard]] Quadric build(const spec::Paraboloid& paraboloid, const LoadContext& context);
[[nodiscard]] Mesh build(const spec::Prism& prism, const LoadContext& context);
/// Reports texture coordinates that do not match the vertices in number, and the errors of `check_mesh`: a
/// vertex that is not finite or does not exist, and a mesh without area. Returns nothing after an error.
/// Throws Error{resource} if the memory limit is exceeded.
[[nodiscard]] std::optional<Mesh> build(const spec::InlineMesh& mesh, const LoadContext& context);

}  // namespace abbe::description

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include <ImathMatrix.h>
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
/// Surfaces that may be lights by themselves. The irradiance on their axis is a formula.
using PlainSurface = std::variant<Quad, Sphere, Disc>;
/// Closed surfaces and quadrics whose irradiance on the axis is not a formula.
using SolidSurface = std::variant<Cylinder, Cone, Paraboloid, Prism>;
/// A variant with `Of<S>` for each alternative S of a variant.
template <template <typename> typename Of, typename Surfaces>
struct Each;
template <template <typename> typename Of, typename... S>
struct Each<Of, std::variant<S...>> {
  using type = std::variant<Of<S>...>;
};

/// Surfaces of other programs' scenes.
using MovableSurface = Joined<PlainSurface, std::variant<Cylinder, InlineMesh>>::type;
/// An affine map of a surface.
struct SurfaceMap {
  Imath::M44d matrix;           ///< For row vectors.
  std::optional<double> scale;  ///< Factor of all lengths, if it is the same.
  bool mirrors = false;         ///< True if the matrix changes handedness.
  bool reverses = false;        ///< True if the front becomes the back.
  bool textured = false;        ///< True if texture coordinates must be preserved.
  bool emits = false;           ///< True if the front emits.
};
/// The surface as mapped, or its triangles. After a reflection the front is the reflected front.
/// Spheres stay as they are if reversed. Nothing if the map does not preserve the form, a texture or the
/// emitting side.
[[nodiscard]] std::optional<MovableSurface> moved(const Quad& quad, const SurfaceMap& by);
[[nodiscard]] std::optional<MovableSurface> moved(const Sphere& sphere, const SurfaceMap& by);
[[nodiscard]] std::optional<MovableSurface> moved(const Disc& disc, const SurfaceMap& by);
[[nodiscard]] std::optional<MovableSurface> moved(const Cylinder& cylinder, const SurfaceMap& by);
[[nodiscard]] std::optional<MovableSurface> moved(const InlineMesh& mesh, const SurfaceMap& by);
/// Triangles of a surface, without caps, with texture coordinates from 0 to 1. Those of curved surfaces are
/// as in `swept`.
[[nodiscard]] InlineMesh triangles_of(const Quad& quad);
[[nodiscard]] InlineMesh triangles_of(const Sphere& sphere);
[[nodiscard]] InlineMesh triangles_of(const Disc& disc);
[[nodiscard]] InlineMesh triangles_of(const Cylinder& cylinder);
[[nodiscard]] inline InlineMesh triangles_of(const InlineMesh& mesh) {
  return mesh;
}
/// The surface of revolution about z of a polyline of two or more points (r, z), r >= 0. The azimuth runs
/// from 0 at +x over +y to `azimuth_deg`, in (0, 360], in facets of at most 5.625 degrees. Its front is along
/// (increasing azimuth) x (along the line). Texture coordinates run from 0 to 1: u with the azimuth, v from
/// point to point.
[[nodiscard]] InlineMesh swept(const std::vector<Imath::V2d>& line, double azimuth_deg);
/// The part of a sphere around the origin with z between `low` and `high`, as triangles. The heights are
/// clamped to [-radius, radius]. The azimuth is that of `swept`. The front is outside; v increases with z.
[[nodiscard]] InlineMesh swept_sphere(double radius, double low, double high, double azimuth_deg);

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

#include "description/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <ImathMatrixAlgo.h>
#include <fmt/format.h>

#include "description/meshes/mesh_file.h"
#include "description/value_ranges.h"
#include "scene/shapes/mesh.h"

namespace abbe::spec {
namespace {

using Imath::M44d;
using Imath::V3d;

constexpr int kFacetsPerTurn = 64;
constexpr int kFacetsPerHalfTurn = 32;

// True if the matrix only translates and scales, so that longitudes and latitudes are preserved.
bool preserves_axes(const M44d& m) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i == j ? m[i][j] <= 0 : m[i][j] != 0) return false;
  return true;
}

InlineMesh transformed(InlineMesh mesh, const M44d& by) {
  for (std::array<double, 3>& vertex : mesh.vertices) {
    const V3d p = V3d(vertex[0], vertex[1], vertex[2]) * by;
    vertex = {p.x, p.y, p.z};
  }
  return mesh;
}

// A surface of revolution about z, as triangles around an axis that starts at `from`.
InlineMesh around(const V3d& axis, const V3d& from, const std::vector<Imath::V2d>& line) {
  const M44d turn = Imath::rotationMatrix(V3d(0, 0, 1), axis.normalized());
  return transformed(swept(line, 360), turn * M44d().setTranslation(from));
}

}  // namespace

std::optional<MovableSurface> moved(const Quad& quad, const SurfaceMap& by) {
  V3d u = moved_direction(quad.edge_u, by.matrix);
  V3d v = moved_direction(quad.edge_v, by.matrix);
  if (by.mirrors != by.reverses) {
    if (by.textured) return moved(triangles_of(quad), by);
    std::swap(u, v);
  }
  return Quad{quad.corner * by.matrix, u, v, quad.where};
}

// Longitudes and latitudes count only on textures.
std::optional<MovableSurface> moved(const Sphere& sphere, const SurfaceMap& by) {
  if (!by.scale || (by.textured && !preserves_axes(by.matrix))) return std::nullopt;
  return Sphere{sphere.center * by.matrix, sphere.radius * *by.scale};
}

std::optional<MovableSurface> moved(const Disc& disc, const SurfaceMap& by) {
  if (!by.scale || by.textured) return std::nullopt;
  const V3d normal = moved_direction(disc.normal, by.matrix).normalized() * (by.reverses ? -1.0 : 1.0);
  return Disc{disc.center * by.matrix, normal, disc.radius * *by.scale};
}

std::optional<MovableSurface> moved(const Cylinder& cylinder, const SurfaceMap& by) {
  if (!by.scale || by.textured || (by.reverses && by.emits)) return std::nullopt;
  return Cylinder{cylinder.from * by.matrix, cylinder.to * by.matrix, cylinder.radius * *by.scale,
                  cylinder.caps, cylinder.where};
}

std::optional<MovableSurface> moved(const InlineMesh& mesh, const SurfaceMap& by) {
  InlineMesh result = transformed(mesh, by.matrix);
  if (by.mirrors != by.reverses)
    for (auto& triangle : result.triangles) std::swap(triangle[1], triangle[2]);
  return result;
}

InlineMesh triangles_of(const Quad& quad) {
  InlineMesh mesh;
  mesh.uv.emplace();
  for (const auto& [u, v] : std::array<std::array<double, 2>, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}) {
    const V3d at = quad.corner + quad.edge_u * u + quad.edge_v * v;
    mesh.vertices.push_back({at.x, at.y, at.z});
    mesh.uv->value.push_back({u, v});
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

InlineMesh triangles_of(const Sphere& sphere) {
  return transformed(swept_sphere(sphere.radius, -sphere.radius, sphere.radius, 360),
                     M44d().setTranslation(sphere.center));
}

InlineMesh triangles_of(const Disc& disc) {
  return around(disc.normal, disc.center, {{disc.radius, 0}, {0, 0}});
}

InlineMesh triangles_of(const Cylinder& cylinder) {
  const V3d axis = cylinder.to - cylinder.from;
  return around(axis, cylinder.from, {{cylinder.radius, 0}, {cylinder.radius, axis.length()}});
}

InlineMesh swept(const std::vector<Imath::V2d>& line, double azimuth_deg) {
  InlineMesh mesh;
  mesh.uv.emplace();
  const int columns = std::max(3, static_cast<int>(std::ceil(kFacetsPerTurn * azimuth_deg / 360)));
  const auto rows = static_cast<int>(line.size());
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double fraction = static_cast<double>(i) / columns;
      // A full turn ends at azimuth 0, so that the seam is closed.
      const double phi =
          i == columns && azimuth_deg == 360 ? 0 : fraction * azimuth_deg * std::numbers::pi / 180;
      const Imath::V2d& at = line[static_cast<std::size_t>(j)];
      mesh.vertices.push_back({at.x * std::cos(phi), at.x * std::sin(phi), at.y});
      mesh.uv->value.push_back({fraction, static_cast<double>(j) / (rows - 1)});
    }
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i);
      const std::uint32_t b = a + static_cast<std::uint32_t>(columns) + 1;
      // At the axis one of the two triangles is degenerate.
      if (line[static_cast<std::size_t>(j)].x > 0) mesh.triangles.push_back({a, a + 1, b + 1});
      if (line[static_cast<std::size_t>(j) + 1].x > 0) mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

InlineMesh swept_sphere(double radius, double low, double high, double azimuth_deg) {
  const double from = std::asin(std::clamp(low / radius, -1.0, 1.0));
  const double to = std::asin(std::clamp(high / radius, -1.0, 1.0));
  std::vector<Imath::V2d> line;
  for (int j = 0; j <= kFacetsPerHalfTurn; ++j) {
    const double latitude = from + (to - from) * j / kFacetsPerHalfTurn;
    const bool pole = std::abs(std::abs(latitude) - std::numbers::pi / 2) < 1e-9;
    line.emplace_back(pole ? 0 : radius * std::cos(latitude), radius * std::sin(latitude));
  }
  return swept(line, azimuth_deg);
}

using namespace schema;

Fields fields(Tag<Sphere>) {
  return describe("sphere", "A sphere, which emits outwards.",
                  {field("center", &Sphere::center, kCoordinate, "Position of its center."),
                   field("radius", &Sphere::radius, kLength, "Radius.")});
}

Fields fields(Tag<Disc>) {
  return describe("disc", "A flat disc, which emits along its normal.",
                  {field("center", &Disc::center, kCoordinate, "Position of its center."),
                   field("normal", &Disc::normal, direction(), "Outward direction."),
                   field("radius", &Disc::radius, kLength, "Radius.")});
}

Fields fields(Tag<Quad>) {
  return describe("quad", "A parallelogram. Its front, where it emits, faces edge_u x edge_v.",
                  {field("corner", &Quad::corner, kCoordinate, "Position of a corner."),
                   field("edge_u", &Quad::edge_u, kCoordinate, "Edge from the corner along one side."),
                   field("edge_v", &Quad::edge_v, kCoordinate,
                         "Edge from the corner along the other side; the normal is edge_u x edge_v.")});
}

Fields fields(Tag<Cylinder>) {
  return describe(
      "cylinder", "The curved surface of a cylinder, which emits outwards.",
      {field("from", &Cylinder::from, kCoordinate, "Center of one end."),
       field("to", &Cylinder::to, kCoordinate, "Center of the other end."),
       field("radius", &Cylinder::radius, kLength, "Radius."),
       defaulted("caps", &Cylinder::caps, "True to close both ends with discs, so that it is a solid.")});
}

Fields fields(Tag<Cone>) {
  return describe(
      "cone", "The curved surface of a cone, which emits outwards.",
      {field("base", &Cone::base, kCoordinate, "Center of the base."),
       field("apex", &Cone::apex, kCoordinate, "Position of the apex."),
       field("radius", &Cone::radius, kLength, "Radius of the base."),
       defaulted("caps", &Cone::caps, "True to close the base with a disc, so that it is a solid.")});
}

Fields fields(Tag<Paraboloid>) {
  return describe(
      "paraboloid", "A paraboloid of revolution, which emits from its convex side.",
      {field("vertex", &Paraboloid::vertex, kCoordinate, "Position of the vertex."),
       field("axis", &Paraboloid::axis, direction(), "Direction from the vertex to the focus."),
       field("focal_length", &Paraboloid::focal_length, kLength, "Distance from the vertex to the focus."),
       field("radius", &Paraboloid::radius, kLength, "Radius of the rim.")});
}

Fields fields(Tag<Prism>) {
  return describe("prism",
                  "A right prism along y with an isosceles cross-section, whose apex points along +z.",
                  {field("apex_deg", &Prism::apex_deg, Range{0, 180, true, true, "degrees"},
                         "Angle between the two equal faces."),
                   field("side", &Prism::side, kLength, "Width of the equal faces."),
                   field("length", &Prism::length, kLength, "Length along y.")});
}

Fields fields(Tag<InlineMesh>) {
  using Triangle = std::array<std::uint32_t, 3>;
  using Vertex = std::array<double, 3>;
  using Coordinates = std::array<double, 2>;
  return describe(
      "inline_mesh", "Triangles, counter-clockwise as seen from outside.",
      {field("vertices", &InlineMesh::vertices, list<Vertex>(vector<Vertex>(kCoordinate), "rows", 1),
             "Positions of the vertices."),
       field("triangles", &InlineMesh::triangles,
             list<Triangle>(vector<Triangle>({0, 4294967295.0}), "rows", 1),
             "Indices of the three vertices of each triangle, counted from 0."),
       field("uv", &InlineMesh::uv, list<Coordinates>(vector<Coordinates>(kCoordinate.in("")), "rows", 1),
             "Texture coordinates of each vertex.")});
}

}  // namespace abbe::spec

namespace abbe::description {

Sphere build(const spec::Sphere& sphere, const LoadContext& context) {
  return {sphere.center * context.unit_m, sphere.radius * context.unit_m};
}

Disc build(const spec::Disc& disc, const LoadContext& context) {
  return {disc.center * context.unit_m, disc.normal.normalized(), disc.radius * context.unit_m};
}

std::optional<Quad> build(const spec::Quad& quad, const LoadContext& context) {
  const Quad built{quad.corner * context.unit_m, quad.edge_u * context.unit_m, quad.edge_v * context.unit_m};
  if (built.edge_u.cross(built.edge_v).length() > 0) return built;
  context.diagnostics.error(quad.where,
                            "edge_u and edge_v are parallel: a quad of zero area (got 0, allowed (0, inf))",
                            ErrorCode::input);
  return std::nullopt;
}

// True if the ends of an axis differ; reports them otherwise.
static bool has_length(const Imath::V3d& axis, const char* ends, const SourcePosition& where,
                       const LoadContext& context) {
  if (axis.length() > 0) return true;
  context.diagnostics.error(
      where, fmt::format("{} are at the same position: a length of zero (got 0, allowed (0, inf))", ends),
      ErrorCode::input);
  return false;
}

std::optional<Quadric> build(const spec::Cylinder& spec, const LoadContext& context) {
  const double unit = context.unit_m;
  if (!has_length(spec.to * unit - spec.from * unit, "from and to", spec.where, context)) return std::nullopt;
  return cylinder(spec.from * unit, spec.to * unit, spec.radius * unit, spec.caps);
}

std::optional<Quadric> build(const spec::Cone& spec, const LoadContext& context) {
  const double unit = context.unit_m;
  if (!has_length(spec.apex * unit - spec.base * unit, "base and apex", spec.where, context))
    return std::nullopt;
  return cone(spec.base * unit, spec.apex * unit, spec.radius * unit, spec.caps);
}

Quadric build(const spec::Paraboloid& spec, const LoadContext& context) {
  const double unit = context.unit_m;
  return paraboloid(spec.vertex * unit, spec.axis, spec.focal_length * unit, spec.radius * unit);
}

Mesh build(const spec::Prism& prism, const LoadContext& context) {
  return make_prism(prism.apex_deg, prism.side * context.unit_m, prism.length * context.unit_m);
}

std::optional<Mesh> build(const spec::InlineMesh& mesh, const LoadContext& context) {
  if (mesh.uv && mesh.uv->value.size() != mesh.vertices.size()) {
    context.diagnostics.error(mesh.uv->where,
                              fmt::format("as many uv as vertices are needed (got {}, allowed {})",
                                          mesh.uv->value.size(), mesh.vertices.size()));
    return std::nullopt;
  }
  Mesh built;
  context.take_memory(
      "triangles of the scene",
      mesh.vertices.size() * sizeof(Imath::V3d) +
          mesh.triangles.size() * (sizeof mesh.triangles[0] + (mesh.uv ? 3 * sizeof(Imath::V2f) : 0)));
  for (const auto& [x, y, z] : mesh.vertices) built.vertices.emplace_back(x, y, z);
  built.triangles = mesh.triangles;
  if (!check_mesh(built, mesh.where, context.diagnostics)) return std::nullopt;
  for (Imath::V3d& vertex : built.vertices) vertex *= context.unit_m;
  if (!mesh.uv) return built;
  const auto at = [&](std::uint32_t i) {
    const auto& [u, v] = mesh.uv->value[i];
    return Imath::V2f(Imath::V2d(u, v));
  };
  for (const auto& [a, b, c] : built.triangles) built.coordinates.push_back({at(a), at(b), at(c)});
  return built;
}

}  // namespace abbe::description

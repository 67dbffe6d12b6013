#include "description/doors/pbrt/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/doors/pbrt/lights.h"
#include "description/meshes/mesh_file.h"
#include "scene/shapes/mesh.h"

namespace abbe::doors::pbrt {
namespace {

using Surface = decltype(GivenShape::surface);

const std::vector<std::string> kShapeTypes{"bilinearmesh", "curve",   "cylinder", "disk",
                                           "loopsubdiv",   "plymesh", "sphere",   "trianglemesh"};

void report_missing(const Made& made, std::string_view name, World& world) {
  world.door.diagnostics.error(made.where, fmt::format("a shape \"{}\" needs \"{}\"", made.type, name));
}

std::vector<std::array<double, 3>> points(const Parameters& p, World& world) {
  const std::vector<double> numbers = p.numbers("P", world.door);
  std::vector<std::array<double, 3>> points;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return points;
}

// The points at the corners of faces that have `count` each, without "indices" those of one face. Nothing,
// after an error, for an index of no point and for other points than those of one face without any.
std::optional<std::vector<std::uint32_t>> indices(const Made& made, std::size_t points, std::size_t count,
                                                  World& world) {
  std::vector<std::uint32_t> indices;
  if (!made.parameters.has("indices") && points != count) {
    world.door.diagnostics.error(
        made.where, fmt::format("a shape \"{}\" needs \"indices\" unless it has {} points (got {})",
                                made.type, count, points));
    return std::nullopt;
  }
  if (!made.parameters.has("indices")) indices.resize(count);
  std::iota(indices.begin(), indices.end(), 0U);
  for (const double index : made.parameters.numbers("indices", world.door)) {
    if (index >= 0 && index < static_cast<double>(points)) {
      indices.push_back(static_cast<std::uint32_t>(index));
      continue;
    }
    world.door.diagnostics.error(
        made.where, fmt::format("a corner is no point (got {}, allowed [0, {}])", index, points - 1));
    return std::nullopt;
  }
  const std::size_t more = indices.size() % count;
  if (more > 0)
    world.door.note(
        made.where,
        fmt::format("indices behind the last whole face of a shape \"{}\" are dropped", made.type));
  indices.resize(indices.size() - more);
  return indices;
}

void add_coordinates(const Made& made, spec::InlineMesh& mesh, World& world) {
  const Parameters& p = made.parameters;
  const std::vector<double> uv = p.numbers(p.has("st") ? "st" : "uv", world.door);
  if (uv.empty()) return;
  if (uv.size() != 2 * mesh.vertices.size())
    return world.door.note(made.where, "texture coordinates that are not as many as points are dropped");
  mesh.uv.emplace();
  for (std::size_t i = 0; i + 1 < uv.size(); i += 2) mesh.uv->value.push_back({uv[i], uv[i + 1]});
}

void note_normals(const Made& made, World& world) {
  if (made.parameters.has("N"))
    world.door.note(made.where,
                    "vertex normals of triangles in the scene file are dropped: those of mesh "
                    "files are read");
  made.parameters.ignore({"N", "S", "faceIndices"});
}

std::optional<Surface> triangle_mesh(const Made& made, World& world) {
  spec::InlineMesh mesh;
  mesh.where = made.where;
  mesh.vertices = points(made.parameters, world);
  if (mesh.vertices.empty()) {
    report_missing(made, "P", world);
    return std::nullopt;
  }
  const auto corners = indices(made, mesh.vertices.size(), 3, world);
  if (!corners) return std::nullopt;
  for (std::size_t i = 0; i + 2 < corners->size(); i += 3)
    mesh.triangles.push_back({(*corners)[i], (*corners)[i + 1], (*corners)[i + 2]});
  add_coordinates(made, mesh, world);
  note_normals(made, world);
  return mesh;
}

bool is_parallelogram(const Imath::V3d& p00, const Imath::V3d& p10, const Imath::V3d& p01,
                      const Imath::V3d& p11) {
  return (p00 + p11 - p10 - p01).length() <= 1e-6 * (p11 - p00).length();
}

// Whether corners have the coordinates of a parallelogram that has none of its own.
bool has_plain_coordinates(const spec::InlineMesh& mesh, const std::vector<std::uint32_t>& corners) {
  constexpr std::array<std::array<double, 2>, 4> kPlain{{{0, 0}, {1, 0}, {0, 1}, {1, 1}}};
  if (!mesh.uv) return true;
  return std::ranges::equal(corners, kPlain, {}, [&](std::uint32_t i) { return mesh.uv->value[i]; });
}

// Patches of four corners each; a single plain one stays a parallelogram.
std::optional<Surface> bilinear_mesh(const Made& made, World& world) {
  const auto vertices = points(made.parameters, world);
  if (vertices.empty()) {
    report_missing(made, "P", world);
    return std::nullopt;
  }
  const auto corners = indices(made, vertices.size(), 4, world);
  if (!corners) return std::nullopt;
  const auto at = [&](std::size_t i) {
    const auto& v = vertices[(*corners)[i]];
    return Imath::V3d(v[0], v[1], v[2]);
  };
  spec::InlineMesh mesh;
  mesh.where = made.where;
  mesh.vertices = vertices;
  note_normals(made, world);
  add_coordinates(made, mesh, world);
  for (std::size_t i = 0; i + 3 < corners->size(); i += 4) {
    const bool plain = is_parallelogram(at(i), at(i + 1), at(i + 2), at(i + 3));
    if (plain && corners->size() == 4 && has_plain_coordinates(mesh, *corners))
      return spec::Quad{at(0), at(1) - at(0), at(2) - at(0), made.where};
    const Imath::V3d normal = (at(i + 1) - at(i)).cross(at(i + 2) - at(i));
    if (std::abs(normal.normalized().dot(at(i + 3) - at(i))) > 1e-6 * (at(i + 3) - at(i)).length())
      world.door.note(made.where, "a curved patch becomes two flat triangles");
    const auto corner = [&](std::size_t j) { return (*corners)[i + j]; };
    mesh.triangles.push_back({corner(0), corner(1), corner(3)});
    mesh.triangles.push_back({corner(0), corner(3), corner(2)});
  }
  return mesh;
}

std::optional<Surface> ply_mesh(const Made& made, World& world) {
  const Parameter* name = made.parameters.find("filename", {"string"}, world.door);
  if (name == nullptr) {
    report_missing(made, "filename", world);
    return std::nullopt;
  }
  const auto path = world.folder / name->texts.front();
  if (!world.door.take_file(path, name->where)) return std::nullopt;
  // Read once to say here what is wrong with it.
  if (!load_mesh_file(path, FileMaterials::ignored, name->where, world.door.diagnostics,
                      FileCoordinates::ignored, world.door.inputs))
    return std::nullopt;
  made.parameters.ignore({"edgelength"});
  return MeshFileSurface{path};
}

Surface noted(Surface surface, const Made& made, World& world) {
  world.door.note(made.where, fmt::format("a curved \"{}\" becomes flat triangles", made.type));
  return surface;
}

std::optional<Surface> sphere(const Made& made, World& world) {
  const Parameters& p = made.parameters;
  const double radius = p.number("radius", 1, world.door);
  const double low = p.number("zmin", -radius, world.door);
  const double high = p.number("zmax", radius, world.door);
  const double phi = p.number("phimax", 360, world.door);
  if (low <= -radius && high >= radius && phi >= 360) return spec::Sphere{{0, 0, 0}, radius};
  return noted(swept_sphere(radius, std::min(low, high), std::max(low, high), phi), made, world);
}

std::optional<Surface> disk(const Made& made, World& world) {
  const Parameters& p = made.parameters;
  const double height = p.number("height", 0, world.door);
  const double radius = p.number("radius", 1, world.door);
  const double inner = p.number("innerradius", 0, world.door);
  const double phi = p.number("phimax", 360, world.door);
  if (inner == 0 && phi >= 360) return spec::Disc{{0, 0, height}, {0, 0, 1}, radius};
  return noted(swept({{radius, height}, {inner, height}}, phi), made, world);
}

std::optional<Surface> cylinder(const Made& made, World& world) {
  const Parameters& p = made.parameters;
  const double radius = p.number("radius", 1, world.door);
  const double low = p.number("zmin", -1, world.door);
  const double high = p.number("zmax", 1, world.door);
  return noted(swept({{radius, low}, {radius, high}}, p.number("phimax", 360, world.door)), made, world);
}

std::optional<Surface> surface_of(const Made& made, World& world) {
  const std::string& type = made.type;
  if (type == "trianglemesh") return triangle_mesh(made, world);
  if (type == "bilinearmesh") return bilinear_mesh(made, world);
  if (type == "plymesh") return ply_mesh(made, world);
  if (type == "sphere") return sphere(made, world);
  if (type == "disk") return disk(made, world);
  if (type == "cylinder") return cylinder(made, world);
  if (std::ranges::find(kShapeTypes, type) == kShapeTypes.end()) {
    world.door.diagnostics.error(made.where, unknown_name("shape", type, kShapeTypes));
    return std::nullopt;
  }
  world.door.note(made.where, fmt::format("a shape \"{}\" has no counterpart here: dropped", type));
  made.parameters.ignore(
      {"P", "N", "indices", "levels", "type", "width", "width0", "width1", "basis", "degree"});
  return std::nullopt;
}

// Gives corners the normals that "N" says of points, if it does so of all.
void add_corner_normals(const Parameters& p, Mesh& mesh, World& world) {
  const std::vector<double> said = p.numbers("N", world.door);
  if (said.size() != 3 * mesh.vertices.size()) return;
  const auto at = [&said](std::uint32_t i) {
    return Imath::V3f(Imath::V3d(said[3 * i], said[3 * i + 1], said[3 * i + 2]));
  };
  for (const auto& [a, b, c] : mesh.triangles) mesh.normals.push_back({at(a), at(b), at(c)});
}

// The triangles of a surface before they are placed, a parallelogram being two, with their normals; none of
// one that is curved. What is wrong with a file has been told.
Mesh unplaced_triangles(const GivenShape& shape, const Parameters& p, World& world) {
  Mesh mesh;
  if (const auto* said = std::get_if<spec::InlineMesh>(&shape.surface)) {
    for (const auto& [x, y, z] : said->vertices) mesh.vertices.emplace_back(x, y, z);
    mesh.triangles = said->triangles;
    add_corner_normals(p, mesh, world);
  }
  if (const auto* said = std::get_if<spec::Quad>(&shape.surface)) {
    const auto& [corner, u, v, where] = *said;
    mesh = {{corner, corner + u, corner + v, corner + u + v}, {{0, 1, 3}, {0, 3, 2}}};
    add_corner_normals(p, mesh, world);
  }
  if (const auto* said = std::get_if<MeshFileSurface>(&shape.surface)) {
    Diagnostics told;
    auto file = load_mesh_file(said->file, FileMaterials::ignored, shape.where, told,
                               FileCoordinates::ignored, world.door.inputs);
    if (file && !file->submeshes.empty()) mesh = std::move(file->submeshes.front().mesh);
  }
  return mesh;
}

// The areas of the faces that are a light each there: of meshes each triangle, or each patch, which is two
// triangles here. All else is one face, even where triangles stand for it here.
std::vector<double> emitting_faces(const Imath::M44d& to_world, Mesh mesh, const std::string& type) {
  const bool patches = type == "bilinearmesh";
  if (!patches && type != "trianglemesh" && type != "plymesh") return {1};
  for (Imath::V3d& vertex : mesh.vertices) vertex *= to_world;
  std::vector<double> areas;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (patches && i % 2 == 1)
      areas.back() += area_vector(mesh, i).length();
    else
      areas.push_back(area_vector(mesh, i).length());
  std::erase(areas, 0);
  return areas.empty() ? std::vector<double>{1} : areas;
}

spec::Emission emission_of_faces(const ShapeUse& use, const Mesh& mesh, World& world) {
  const Made& light = *use.emission;
  const std::string& type = use.made.type;
  if (!light.parameters.has("power")) return area_emission(light, {1}, world);
  if (type == "plymesh")
    world.door.note(use.made.where,
                    "\"power\" is that of each face of a \"plymesh\": one of four corners, a single light "
                    "there, counts as two here");
  return area_emission(light, emitting_faces(use.to_world, mesh, type), world);
}

}  // namespace

void add_shape(const ShapeUse& use, Among among, std::vector<spec::Shape>& shapes, World& world) {
  auto surface = surface_of(use.made, world);
  use.made.parameters.note_unused(fmt::format("shape \"{}\"", use.made.type), world.door);
  if (!surface) return;
  GivenShape shape;
  shape.surface = *std::move(surface);
  shape.to_world = use.to_world;
  shape.turned = use.reversed;
  shape.material = use.material;
  shape.where = use.made.where;
  if (use.emission && among == Among::object) {
    world.door.note(use.made.where, "what instances place does not emit here: its light is dropped");
  } else if (use.emission) {
    const Mesh mesh = unplaced_triangles(shape, use.made.parameters, world);
    shape.emission = emission_of_faces(use, mesh, world);
    shape.two_sided = use.emission->parameters.truth("twosided", false, world.door);
    heed_normals(mesh, shape, world.door);
    use.emission->parameters.note_unused("area light", world.door);
  }
  place(std::move(shape), among, shapes, world.door);
}

}  // namespace abbe::doors::pbrt

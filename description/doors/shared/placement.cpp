#include "description/doors/shared/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <ImathMatrixAlgo.h>
#include <fmt/format.h>

#include "description/doors/shared/materials.h"
#include "description/meshes/mesh_file.h"
#include "scene/shapes/mesh.h"

namespace abbe::doors {
namespace {

using Imath::M44d;
using Imath::V3d;

constexpr int kAround = 64;  // facets of a whole turn
constexpr int kAlong = 32;   // of half a turn

V3d row(const M44d& m, int i) {
  return {m[i][0], m[i][1], m[i][2]};
}

// The factor by which all lengths are scaled, if all are alike; as exact as scenes write rotations.
std::optional<double> uniform_scale(const M44d& m) {
  constexpr double kTolerance = 1e-5;
  const double s2 = row(m, 0).length2();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::abs(row(m, i).dot(row(m, j)) - (i == j ? s2 : 0)) > kTolerance * s2) return std::nullopt;
  return std::sqrt(s2);
}

V3d moved_point(const V3d& p, const M44d& m) {
  return p * m;
}
V3d moved_vector(const V3d& v, const M44d& m) {
  V3d to;
  m.multDirMatrix(v, to);
  return to;
}

spec::Similarity step_of(const M44d& m, double scale) {
  spec::Similarity step;
  if (scale != 1) step.scale = scale;
  const Imath::Quatd turn = Imath::extractQuat(M44d(m) * scaling(V3d(1 / scale)));
  const double angle = turn.angle();
  if (angle != 0 && turn.axis().length2() > 0)
    step.rotate = spec::Rotation{turn.axis(), angle * 180 / std::numbers::pi};
  const V3d by = row(m, 3);
  if (by != V3d(0)) step.translate = by;
  return step;
}

// Whether it moves and scales alone, so that longitudes and latitudes stay where they are.
bool keeps_axes(const M44d& m) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i == j ? m[i][j] <= 0 : m[i][j] != 0) return false;
  return true;
}

spec::InlineMesh triangles_of(const spec::Quad& quad) {
  spec::InlineMesh mesh;
  mesh.uv.emplace();
  for (const auto& [u, v] : std::array<std::array<double, 2>, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}) {
    const V3d at = quad.corner + quad.edge_u * u + quad.edge_v * v;
    mesh.vertices.push_back({at.x, at.y, at.z});
    mesh.uv->value.push_back({u, v});
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

template <typename Body>
void describe(Body& body, const GivenShape& given) {
  body.material = spec::MaterialName{{given.material}, given.where};
  if (!given.emission) return;
  body.emission.emplace();
  static_cast<spec::Emission&>(*body.emission) = *given.emission;
  body.two_sided = given.two_sided;
}

template <typename Surface>
spec::Shape shape_of(Surface surface, const GivenShape& given,
                     const std::vector<spec::Similarity>& transform = {}) {
  using Body =
      std::conditional_t<std::is_same_v<Surface, spec::Mesh>, spec::MeshBody, spec::PlainBody<Surface>>;
  Body body;
  body.surface = std::move(surface);
  body.transform = transform;
  describe(body, given);
  return {given.name, std::move(body), given.where};
}

spec::Mesh mesh_of(spec::Mesh::Wrapped mesh, const SourcePosition& where) {
  spec::Mesh said;
  said.value = std::move(mesh);
  said.where = where;
  return said;
}

spec::InlineMesh moved(spec::InlineMesh mesh, const M44d& m, bool turned) {
  for (std::array<double, 3>& vertex : mesh.vertices) {
    const V3d p = moved_point({vertex[0], vertex[1], vertex[2]}, m);
    vertex = {p.x, p.y, p.z};
  }
  if (turned)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

/// Places one kind of surface after the other; false where it cannot stay what it is. Images lie on spheres
/// that keep their axes, and on quads that are not turned round, as they do there; on discs they do not.
struct Placer {
  const GivenShape& given;
  bool textured;
  std::vector<spec::Shape>& shapes;
  Door& door;
  const M44d& m = given.to_world;

  bool operator()(const spec::Sphere& sphere) const {
    const auto scale = uniform_scale(m);
    if (!scale || (textured && !keeps_axes(m))) return false;
    if (given.turned && given.emission)
      door.note(given.where, "a sphere emits outwards here, and inwards there");
    shapes.push_back(shape_of(spec::Sphere{moved_point(sphere.center, m), sphere.radius * *scale}, given));
    return true;
  }
  bool operator()(const spec::Disc& disc) const {
    const auto scale = uniform_scale(m);
    if (!scale || textured) return false;
    const V3d normal = moved_vector(disc.normal, m).normalized() * (given.turned ? -1.0 : 1.0);
    shapes.push_back(shape_of(spec::Disc{moved_point(disc.center, m), normal, disc.radius * *scale}, given));
    return true;
  }
  bool operator()(const spec::Quad& quad) const {
    V3d u = moved_vector(quad.edge_u, m);
    V3d v = moved_vector(quad.edge_v, m);
    if (mirrors(m) != given.turned) {
      if (textured) return (*this)(triangles_of(quad));
      std::swap(u, v);
    }
    shapes.push_back(shape_of(spec::Quad{moved_point(quad.corner, m), u, v, given.where}, given));
    return true;
  }
  bool operator()(const spec::InlineMesh& mesh) const {
    shapes.push_back(shape_of(mesh_of(moved(mesh, m, mirrors(m) != given.turned), given.where), given));
    return true;
  }
  bool operator()(const MeshFileSurface& mesh) const {
    const auto scale = uniform_scale(m);
    if (!scale || mirrors(m) || (given.turned && given.emission)) return false;
    std::vector<spec::Similarity> steps;
    if (m != M44d()) steps.push_back(step_of(m, *scale));
    shapes.push_back(shape_of(mesh_of(door.name_of(mesh.file), given.where), given, steps));
    return true;
  }
};

// The triangles of a mesh: where they need texture coordinates, which belong to points of the scene's meshes
// and to corners of a file's, each corner is a point.
spec::InlineMesh copy_of(const Mesh& from, bool textured) {
  spec::InlineMesh copy;
  const auto add = [&copy](const V3d& v) { copy.vertices.push_back({v.x, v.y, v.z}); };
  if (!textured) {
    std::ranges::for_each(from.vertices, add);
    copy.triangles = from.triangles;
    return copy;
  }
  copy.uv.emplace();
  for (std::size_t i = 0; i < from.triangles.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(copy.vertices.size());
    copy.triangles.push_back({first, first + 1, first + 2});
    for (std::size_t corner = 0; corner < 3; ++corner) {
      add(from.vertices[from.triangles[i][corner]]);
      const Imath::V2f& uv = from.coordinates[i][corner];
      copy.uv->value.push_back({uv.x, uv.y});
    }
  }
  return copy;
}

/// The surface as triangles in a mesh of its own, nothing after an error.
struct Triangulator {
  const GivenShape& given;
  bool textured;
  Door& door;

  std::optional<spec::InlineMesh> operator()(const spec::Sphere& sphere) const {
    const spec::InlineMesh unit = swept_sphere(sphere.radius, -sphere.radius, sphere.radius, 360);
    return moved(unit, translation(sphere.center), false);
  }
  std::optional<spec::InlineMesh> operator()(const spec::Disc& disc) const {
    M44d turn = Imath::rotationMatrix(V3d(0, 0, 1), disc.normal.normalized());
    spec::InlineMesh mesh = swept({{disc.radius, 0}, {0, 0}}, 360);
    if (given.u_outwards)
      for (auto& uv : mesh.uv->value) uv = {1 - uv[1], uv[0]};
    return moved(std::move(mesh), turn * translation(disc.center), false);
  }
  std::optional<spec::InlineMesh> operator()(const spec::Quad& quad) const { return triangles_of(quad); }
  std::optional<spec::InlineMesh> operator()(const spec::InlineMesh& mesh) const { return mesh; }
  std::optional<spec::InlineMesh> operator()(const MeshFileSurface& mesh) const {
    const auto read = load_mesh_file(mesh.file, FileMaterials::ignored, given.where, door.diagnostics,
                                     FileCoordinates::wanted, door.inputs);
    if (!read || read->submeshes.empty()) return std::nullopt;
    const Mesh& from = read->submeshes.front().mesh;
    if (!from.normals.empty())
      door.note(
          given.where,
          "a mesh file that is stretched, or turned and emits, becomes triangles of the scene: its vertex "
          "normals are dropped");
    return copy_of(from, textured);
  }
};

// Whether the triangles have no texture coordinates, as PLY files have none; other surfaces have their own.
bool lacks_coordinates(const GivenShape& given, const Door& door) {
  if (const auto* mesh = std::get_if<spec::InlineMesh>(&given.surface)) return !mesh->uv;
  const auto* file = std::get_if<MeshFileSurface>(&given.surface);
  if (file == nullptr) return false;
  const auto read = load_mesh_file(file->file, FileMaterials::ignored, given.where, door.diagnostics,
                                   FileCoordinates::wanted, door.inputs);
  return read && std::ranges::any_of(read->submeshes, [](const MeshFile::Submesh& part) {
           return part.mesh.coordinates.empty();
         });
}

// JSON values of triangles in the scene file; none of other surfaces.
std::size_t values_of(const GivenShape& given) {
  const auto* mesh = std::get_if<spec::InlineMesh>(&given.surface);
  if (mesh == nullptr) return 0;
  constexpr std::size_t kTriple = 4;  // a list of three numbers
  return kTriple * (mesh->vertices.size() + mesh->triangles.size() + (mesh->uv ? mesh->uv->value.size() : 0));
}

// The texts of a shape: its name and those of its material and file.
std::size_t bytes_of_texts(const GivenShape& given) {
  const auto* file = std::get_if<MeshFileSurface>(&given.surface);
  return given.material.size() + given.name.value_or("").size() +
         (file != nullptr ? file->file.native().size() : 0);
}

void place_as_object(const GivenShape& given, Door& door) {
  GivenShape plain = given;
  plain.to_world = M44d();
  const std::string name = fmt::format("object of one shape {}", door.scene.objects.size() + 1);
  spec::Object object;
  place(std::move(plain), Among::object, object.shapes, door);
  door.scene.objects.push_back({name, std::move(object), given.where});
  place_instance(name, given.to_world, given.where, door);
  door.scene.shapes.back().name = given.name;
}

}  // namespace

M44d from_rows(const std::vector<double>& rows) {
  M44d m;
  for (std::size_t i = 0; i < rows.size() && i < 16; ++i) m[static_cast<int>(i % 4)][i / 4] = rows[i];
  return m;
}

M44d scaling(const V3d& by) {
  M44d m;
  m.setScale(by);
  return m;
}

M44d translation(const V3d& by) {
  M44d m;
  m.setTranslation(by);
  return m;
}

M44d rotation(const V3d& axis, double deg) {
  M44d m;
  m.setAxisAngle(axis.normalized(), deg * std::numbers::pi / 180);
  return m;
}

bool mirrors(const M44d& m) {
  return row(m, 0).cross(row(m, 1)).dot(row(m, 2)) < 0;
}

void heed_normals(const Mesh& mesh, GivenShape& given, Door& door) {
  if (!given.emission || given.two_sided || mesh.normals.empty()) return;
  double before = 0;
  double behind = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const V3d area = area_vector(mesh, i);
    const auto& [a, b, c] = mesh.normals[i];
    (area.dot(V3d(a + b + c)) < 0 ? behind : before) += area.length();
  }
  if (before > 0 && behind > 0)
    door.note(
        given.where,
        "vertex normals are on both sides of the triangles of a light: those of most of its area say which "
        "side emits");
  if (behind > before) given.turned = !given.turned;
}

void place(GivenShape given, Among among, std::vector<spec::Shape>& shapes, Door& door) {
  door.add_values(kValuesOfOne + values_of(given), bytes_of_texts(given));
  bool textured = is_textured(given.material, door);
  if (textured && lacks_coordinates(given, door)) {
    door.note(given.where, "triangles without texture coordinates take no image: a reflectance of 0.5");
    given.material = without_images(given.material, door);
    textured = false;
  }
  const bool stays = std::visit(Placer{given, textured, shapes, door}, given.surface);
  if (!stays && among == Among::scene && !given.emission) return place_as_object(given, door);
  if (given.turned && is_matter(given.material, door))
    door.note(
        given.where,
        "matter fills a shape that is turned inside out all the same here, and is around it there: a hollow "
        "in matter has a material of its own, of the index of what fills it");
  if (stays) return;
  auto triangles = std::visit(Triangulator{given, textured, door}, given.surface);
  if (!triangles) return;
  if (!std::holds_alternative<MeshFileSurface>(given.surface))
    door.note(given.where, "a curved shape that is stretched, or has an image, becomes flat triangles");
  given.surface = *std::move(triangles);
  door.add_values(values_of(given));
  (void)Placer{given, textured, shapes, door}(std::get<spec::InlineMesh>(given.surface));
}

void place_instance(const std::string& object, const M44d& to_world, const SourcePosition& where,
                    Door& door) {
  door.add_values(kValuesOfOne, object.size());
  spec::Instance instance;
  instance.of = {{object}, where};
  instance.where = where;
  spec::Matrix matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) matrix.rows.value.push_back(to_world[j][i]);
  if (to_world != M44d()) instance.transform.value.push_back(std::move(matrix));
  door.scene.shapes.push_back({std::nullopt, std::move(instance), where});
}

spec::InlineMesh swept(const std::vector<Imath::V2d>& line, double azimuth_deg) {
  spec::InlineMesh mesh;
  mesh.uv.emplace();
  const int columns = std::max(3, static_cast<int>(std::ceil(kAround * azimuth_deg / 360)));
  const auto rows = static_cast<int>(line.size());
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double share = static_cast<double>(i) / columns;
      // A whole turn ends where it began, so that its seam is closed.
      const double phi =
          i == columns && azimuth_deg == 360 ? 0 : share * azimuth_deg * std::numbers::pi / 180;
      const Imath::V2d& at = line[static_cast<std::size_t>(j)];
      mesh.vertices.push_back({at.x * std::cos(phi), at.x * std::sin(phi), at.y});
      mesh.uv->value.push_back({share, static_cast<double>(j) / (rows - 1)});
    }
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i);
      const std::uint32_t b = a + static_cast<std::uint32_t>(columns) + 1;
      // At an axis one of the two has no area.
      if (line[static_cast<std::size_t>(j)].x > 0) mesh.triangles.push_back({a, a + 1, b + 1});
      if (line[static_cast<std::size_t>(j) + 1].x > 0) mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

spec::InlineMesh swept_sphere(double radius, double low, double high, double azimuth_deg) {
  const double from = std::asin(std::clamp(low / radius, -1.0, 1.0));
  const double to = std::asin(std::clamp(high / radius, -1.0, 1.0));
  std::vector<Imath::V2d> line;
  for (int j = 0; j <= kAlong; ++j) {
    const double latitude = from + (to - from) * j / kAlong;
    const bool pole = std::abs(std::abs(latitude) - std::numbers::pi / 2) < 1e-9;
    line.emplace_back(pole ? 0 : radius * std::cos(latitude), radius * std::sin(latitude));
  }
  return swept(line, azimuth_deg);
}

}  // namespace abbe::doors

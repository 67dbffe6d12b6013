#include "importers/shared/placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <ImathMatrixAlgo.h>
#include <fmt/format.h>

#include "description/meshes/mesh_file.h"
#include "importers/shared/materials.h"
#include "scene/shapes/mesh.h"

namespace abbe::importers {
namespace {

using Imath::M44d;
using Imath::V3d;

V3d row(const M44d& m, int i) {
  return {m[i][0], m[i][1], m[i][2]};
}

// The scale factor if the matrix scales all lengths equally, within the precision of rotations in scene
// files. Nothing otherwise.
std::optional<double> uniform_scale(const M44d& m) {
  constexpr double kTolerance = 1e-5;
  const double s2 = row(m, 0).length2();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::abs(row(m, i).dot(row(m, j)) - (i == j ? s2 : 0)) > kTolerance * s2) return std::nullopt;
  return std::sqrt(s2);
}

// The step of a transform that equals a matrix with this uniform scale.
spec::Similarity similarity_of(const M44d& m, double scale) {
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

// Sets the material and the emission of a body.
template <typename Body>
void describe(Body& body, const ImportedShape& shape) {
  body.material = spec::MaterialName{{shape.material}, shape.where};
  if (!shape.emission) return;
  body.emission.emplace();
  static_cast<spec::Emission&>(*body.emission) = *shape.emission;
  body.two_sided = shape.two_sided;
}

template <typename Surface>
spec::Shape shape_of(Surface surface, const ImportedShape& shape,
                     const std::vector<spec::Similarity>& transform = {}) {
  using AnalyticBody = std::conditional_t<std::is_same_v<Surface, spec::Cylinder>, spec::SolidBody<Surface>,
                                          spec::PlainBody<Surface>>;
  using Body = std::conditional_t<std::is_same_v<Surface, spec::Mesh>, spec::MeshBody, AnalyticBody>;
  Body body;
  body.surface = std::move(surface);
  body.transform = transform;
  describe(body, shape);
  return {shape.name, std::move(body), shape.where};
}

spec::Mesh mesh_of(spec::Mesh::Wrapped mesh, const SourcePosition& where) {
  spec::Mesh result;
  result.value = std::move(mesh);
  result.where = where;
  return result;
}

/// Adds each kind of surface unchanged. Returns false if the matrix does not allow that.
struct ShapeAppender {
  const ImportedShape& shape;
  bool textured;
  std::vector<spec::Shape>& shapes;
  SceneImporter& importer;
  const M44d& m = shape.to_world;

  template <typename Surface>
  bool operator()(const Surface& surface) const {
    const auto result = spec::moved(
        surface, {m, uniform_scale(m), mirrors(m), shape.reversed, textured, shape.emission.has_value()});
    if (!result) return false;
    if (std::is_same_v<Surface, spec::Sphere> && shape.reversed && shape.emission)
      importer.note(shape.where, "a sphere emits outwards: in the source renderer it emits inwards");
    std::visit([this](const auto& as_moved) { append(as_moved); }, *result);
    return true;
  }
  bool operator()(const MeshFileSurface& mesh) const {
    const auto scale = uniform_scale(m);
    if (!scale || mirrors(m) || (shape.reversed && shape.emission)) return false;
    std::vector<spec::Similarity> steps;
    if (m != M44d()) steps.push_back(similarity_of(m, *scale));
    shapes.push_back(shape_of(mesh_of(importer.name_of(mesh.file), shape.where), shape, steps));
    return true;
  }

 private:
  template <typename Surface>
  void append(const Surface& surface) const {
    if constexpr (std::is_same_v<Surface, spec::InlineMesh>)
      shapes.push_back(shape_of(mesh_of(surface, shape.where), shape));
    else
      shapes.push_back(shape_of(surface, shape));
  }
};

// Copies the triangles of a mesh file. Scene meshes have texture coordinates per vertex, files per corner: if
// they are needed, each corner becomes a vertex.
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

/// Converts a surface to triangles. Nothing after an error.
struct Triangulator {
  const ImportedShape& shape;
  bool textured;
  SceneImporter& importer;

  template <typename Surface>
  std::optional<spec::InlineMesh> operator()(const Surface& surface) const {
    spec::InlineMesh mesh = spec::triangles_of(surface);
    if (std::is_same_v<Surface, spec::Disc> && shape.u_is_radial)
      for (auto& uv : mesh.uv->value) uv = {1 - uv[1], uv[0]};
    return mesh;
  }
  std::optional<spec::InlineMesh> operator()(const MeshFileSurface& mesh) const {
    const auto read = load_mesh_file(mesh.file, FileMaterials::ignored, shape.where, importer.diagnostics,
                                     FileCoordinates::wanted, importer.inputs);
    if (!read || read->submeshes.empty()) return std::nullopt;
    const Mesh& from = read->submeshes.front().mesh;
    if (!from.normals.empty())
      importer.note(shape.where,
                    "a mesh file with a non-uniform scale, or reversed and emitting, is copied as triangles "
                    "into the scene: its vertex normals are dropped");
    return copy_of(from, textured);
  }
};

// True if triangles lack texture coordinates, as in PLY files. Other surfaces have their own.
bool lacks_coordinates(const ImportedShape& shape, const SceneImporter& importer) {
  if (const auto* mesh = std::get_if<spec::InlineMesh>(&shape.surface)) return !mesh->uv;
  const auto* file = std::get_if<MeshFileSurface>(&shape.surface);
  if (file == nullptr) return false;
  const auto read = load_mesh_file(file->file, FileMaterials::ignored, shape.where, importer.diagnostics,
                                   FileCoordinates::wanted, importer.inputs);
  return read && std::ranges::any_of(read->submeshes, [](const MeshFile::Submesh& part) {
           return part.mesh.coordinates.empty();
         });
}

// Number of JSON values of triangles in the scene file; 0 for other surfaces.
std::size_t values_of(const ImportedShape& shape) {
  const auto* mesh = std::get_if<spec::InlineMesh>(&shape.surface);
  if (mesh == nullptr) return 0;
  constexpr std::size_t kTriple = 4;  // A list of three numbers.
  return kTriple * (mesh->vertices.size() + mesh->triangles.size() + (mesh->uv ? mesh->uv->value.size() : 0));
}

// Size of a shape's name, material and file name [bytes].
std::size_t bytes_of_texts(const ImportedShape& shape) {
  const auto* file = std::get_if<MeshFileSurface>(&shape.surface);
  return shape.material.size() + shape.name.value_or("").size() +
         (file != nullptr ? file->file.native().size() : 0);
}

// Adds an object that contains only this shape without its matrix, and an instance of it with the matrix.
void append_as_object(const ImportedShape& shape, SceneImporter& importer) {
  ImportedShape plain = shape;
  plain.to_world = M44d();
  const std::string name = fmt::format("object of one shape {}", importer.scene.objects.size() + 1);
  spec::Object object;
  append_shape(std::move(plain), ShapeOwner::object, object.shapes, importer);
  importer.scene.objects.push_back({name, std::move(object), shape.where});
  append_instance(name, shape.to_world, shape.where, importer);
  importer.scene.shapes.back().name = shape.name;
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

std::optional<M44d> looking_at(const V3d& from, const V3d& target, const V3d& up) {
  const V3d z = (target - from).normalized();
  const V3d right = up.cross(z);
  if (z.length2() == 0 || right.length2() < 1e-24) return std::nullopt;
  const V3d x = right.normalized();
  const V3d y = z.cross(x);
  return M44d(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, from.x, from.y, from.z, 1);
}

bool mirrors(const M44d& m) {
  return row(m, 0).cross(row(m, 1)).dot(row(m, 2)) < 0;
}

void orient_by_normals(const Mesh& mesh, ImportedShape& shape, SceneImporter& importer) {
  if (!shape.emission || shape.two_sided || mesh.normals.empty()) return;
  double before = 0;
  double behind = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const V3d area = area_vector(mesh, i);
    const auto& [a, b, c] = mesh.normals[i];
    (area.dot(V3d(a + b + c)) < 0 ? behind : before) += area.length();
  }
  if (before > 0 && behind > 0)
    importer.note(shape.where,
                  "vertex normals of a light are on both sides of its triangles: those of the larger area "
                  "decide which side emits");
  if (behind > before) shape.reversed = !shape.reversed;
}

void append_shape(ImportedShape shape, ShapeOwner owner, std::vector<spec::Shape>& shapes,
                  SceneImporter& importer) {
  importer.reserve_values(kValuesPerItem + values_of(shape), bytes_of_texts(shape));
  bool textured = is_textured(shape.material, importer);
  if (textured && lacks_coordinates(shape, importer)) {
    importer.note(shape.where,
                  "triangles without texture coordinates cannot have an image: a reflectance of 0.5 is used");
    shape.material = without_images(shape.material, importer);
    textured = false;
  }
  const bool stays = std::visit(ShapeAppender{shape, textured, shapes, importer}, shape.surface);
  if (!stays && owner == ShapeOwner::scene && !shape.emission) return append_as_object(shape, importer);
  if (shape.reversed && fills_interior(shape.material, importer))
    importer.note(shape.where,
                  "a medium fills a reversed shape, but surrounds it in the source renderer: for a cavity, "
                  "use a separate material with the index of its content");
  if (stays) return;
  auto triangles = std::visit(Triangulator{shape, textured, importer}, shape.surface);
  if (!triangles) return;
  if (!std::holds_alternative<MeshFileSurface>(shape.surface))
    importer.note(shape.where,
                  "a curved shape with a non-uniform scale or an image is replaced by triangles");
  shape.surface = *std::move(triangles);
  importer.reserve_values(values_of(shape));
  (void)ShapeAppender{shape, textured, shapes, importer}(std::get<spec::InlineMesh>(shape.surface));
}

void append_instance(const std::string& object, const M44d& to_world, const SourcePosition& where,
                     SceneImporter& importer) {
  importer.reserve_values(kValuesPerItem, object.size());
  spec::Instance instance;
  instance.of = {{object}, where};
  instance.where = where;
  spec::Matrix matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) matrix.rows.value.push_back(to_world[j][i]);
  if (to_world != M44d()) instance.transform.value.push_back(std::move(matrix));
  importer.scene.shapes.push_back({std::nullopt, std::move(instance), where});
}

}  // namespace abbe::importers

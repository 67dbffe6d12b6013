#include "importers/mitsuba/scene_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ImathMatrixAlgo.h>
#include <fmt/format.h>

#include "description/meshes/mesh_file.h"
#include "importers/mitsuba/spectra.h"
#include "importers/shared/placement.h"
#include "importers/shared/scene_importer.h"
#include "scene/lights/infinite_light.h"

namespace abbe::importers::mitsuba {
namespace {

using Imath::M44d;
using Imath::V3d;
using spec::Quantity;
using Surface = decltype(ImportedShape::surface);

const std::vector<std::string> kShapeTypes{"bsplinecurve", "cube",       "cylinder", "disk",      "instance",
                                           "linearcurve",  "obj",        "ply",      "rectangle", "sdfgrid",
                                           "serialized",   "shapegroup", "sphere"};

/// A surface, and the matrix applied before `to_world`.
struct LocalSurface {
  Surface surface;
  M44d matrix{};
  VDirection v = VDirection::down;
  Mesh mesh{};  ///< Contents of a mesh file.
};

/// Directions of the texture coordinates on a side of a cube. The normal is along_v x along_u.
struct CubeSide {
  V3d along_u, along_v;
};
const std::array<CubeSide, 6> kCubeSides{{{{0, 1, 0}, {0, 0, -1}},
                                          {{0, 1, 0}, {0, 0, 1}},
                                          {{-1, 0, 0}, {0, 0, -1}},
                                          {{0, 0, 1}, {1, 0, 0}},
                                          {{0, 1, 0}, {1, 0, 0}},
                                          {{0, -1, 0}, {1, 0, 0}}}};

// The cube [-1, 1]^3; each side has its own texture coordinates.
spec::InlineMesh cube() {
  spec::InlineMesh mesh;
  mesh.uv.emplace();
  for (const auto& [along_u, along_v] : kCubeSides) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [u, v] : std::array<std::array<double, 2>, 4>{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}}) {
      const V3d at = along_v.cross(along_u) + along_u * (2 * u - 1) + along_v * (2 * v - 1);
      mesh.vertices.push_back({at.x, at.y, at.z});
      mesh.uv->value.push_back({u, v});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

bool is_bent(const Mesh& mesh) {
  constexpr double kFlat = 1 - 1e-6;
  std::vector<std::optional<V3d>> normals(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles) {
    const V3d& a = mesh.vertices[triangle[0]];
    const V3d normal = (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).normalized();
    for (const std::uint32_t vertex : triangle) {
      if (normals[vertex].value_or(normal).dot(normal) < kFlat) return true;
      normals[vertex] = normal;
    }
  }
  return false;
}

// Notes differences of normals: Mitsuba computes vertex normals for meshes without them, unless
// "face_normals" is true.
void note_normals(const Object& shape, const MeshFile& file) {
  const Mesh& mesh = file.submeshes.front().mesh;
  const bool flat = shape.boolean("face_normals", false);
  if (flat && !mesh.normals.empty())
    shape.note("\"face_normals\" is not supported: vertex normals of the mesh file are used");
  if (!flat && mesh.normals.empty() && is_bent(mesh))
    shape.note("vertex normals are not computed for a mesh file without them: its triangles are visible");
}

std::optional<LocalSurface> mesh_file(const Object& shape) {
  const auto path = shape.state().folder / shape.text("filename", "");
  if (!shape.importer().check_file(path, shape.where())) return std::nullopt;
  auto file = load_mesh_file(path, FileMaterials::ignored, shape.where(), shape.importer().diagnostics,
                             FileCoordinates::ignored, shape.importer().inputs);
  if (!file) return std::nullopt;
  const bool obj = shape.type() == "obj";
  const bool flips_v = shape.boolean("flip_tex_coords", obj);
  shape.ignore({"max_smooth_angle"});
  LocalSurface local{MeshFileSurface{path}, {}, flips_v ? VDirection::up : VDirection::down};
  if (file->submeshes.empty()) return local;
  note_normals(shape, *file);
  local.mesh = std::move(file->submeshes.front().mesh);
  return local;
}

std::optional<LocalSurface> surface_of(const Object& shape) {
  const std::string& type = shape.type();
  if (type == "rectangle") return LocalSurface{spec::Quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, shape.where()}};
  if (type == "cube") return LocalSurface{cube()};
  if (type == "sphere")
    return LocalSurface{spec::Sphere{shape.point("center", {0, 0, 0}), shape.number("radius", 1)},
                        {},
                        VDirection::up};  // Image rows run down from +z in both renderers.
  if (type == "disk") return LocalSurface{spec::Disc{{0, 0, 0}, {0, 0, 1}, 1}};
  if (type == "cylinder")
    return LocalSurface{spec::Cylinder{shape.point("p0", {0, 0, 0}), shape.point("p1", {0, 0, 1}),
                                       shape.number("radius", 1), false, shape.where()}};
  if (type == "obj" || type == "ply") return mesh_file(shape);
  if (type == "serialized")
    return shape.fail("serialized meshes of Mitsuba are not supported: write PLY or OBJ", ErrorCode::input);
  if (shape.importer().is_known("shape", type, kShapeTypes, shape.where()))
    shape.note(fmt::format("a shape \"{}\" is not supported: dropped", type));
  return std::nullopt;
}

const Element* interior_medium(const Object& shape) {
  if (shape.has("exterior")) shape.note("an exterior medium of a shape is not supported: dropped");
  shape.ignore({"exterior"});
  return shape.find("interior", {"medium"});
}

std::optional<std::string> material_of(const Object& shape, VDirection v, Materials& materials) {
  const Element* interior = interior_medium(shape);
  const auto bsdfs = shape.all("bsdf");
  static const Element kDefault{"bsdf", {{"type", "diffuse"}}};
  return materials.name_of(bsdfs.empty() ? kDefault : *bsdfs.front(), interior, v);
}

std::string add_group(const Object& group, Materials& materials) {
  std::string name = group.element()["id"];
  if (name.empty()) name = fmt::format("shape group {}", group.importer().scene.objects.size() + 1);
  spec::Object object;
  for (const Element* member : group.all("shape"))
    add_shape(Object(*member, group.state()), ShapeOwner::object, object.shapes, materials);
  if (object.shapes.empty())
    group.fail("the shape group is empty");
  else
    group.importer().scene.objects.push_back({name, std::move(object), group.where()});
  return name;
}

// Adds an instance of a shape group, which is a child of the instance or referred to.
void add_instance(const Object& shape, Materials& materials) {
  const auto groups = shape.all("shape");
  const M44d m = shape.transform("to_world") * shape.state().world_mirror;
  if (groups.size() != 1 || (*groups.front())["type"] != "shapegroup")
    return (void)shape.fail("an instance needs one shape group");
  const Element& group = *groups.front();
  const bool is_within = std::ranges::any_of(shape.element().children,
                                             [&group](const Element& child) { return &child == &group; });
  const std::string name = is_within ? add_group(Object(group, shape.state()), materials) : group["id"];
  append_instance(name, m, shape.where(), shape.importer());
}

// Sets the front side of a mesh file as in Mitsuba: the side of the vertex normals or, without any, the side
// given by the triangles' order in world space, also after a reflection.
void orient_mesh(const Object& shape, const Mesh& mesh, ImportedShape& imported) {
  if (!mesh.normals.empty() && !shape.boolean("face_normals", false))
    orient_by_normals(mesh, imported, shape.importer());
  else if (mirrors(shape.transform("to_world")))
    imported.reversed = !imported.reversed;
}

void add_emission(const Object& shape, ShapeOwner owner, ImportedShape& imported) {
  const auto emitters = shape.all("emitter");
  if (emitters.empty()) return;
  const Object light(*emitters.front(), shape.state());
  if (owner == ShapeOwner::object) {
    shape.note("emission inside objects is not supported: dropped");
    return;
  }
  light.importer().is_known("area light", light.type(), {"area"}, light.where());
  imported.emission = emission_of<Quantity::luminance>(light_spectrum(light, "radiance"));
  light.ignore({"sampling_weight"});
  light.note_unused();
}

const std::vector<std::string> kLightTypes{"area",  "constant",  "directional", "directionalarea", "envmap",
                                           "point", "projector", "spot",        "sunsky"};

M44d light_to_world(const Object& light) {
  return light.transform("to_world") * light.state().world_mirror;
}

V3d direction(const V3d& local, const M44d& m) {
  V3d to;
  m.multDirMatrix(local, to);
  return to;
}

void add_point(const Object& light) {
  const V3d at = light.point("position", {0, 0, 0}) * light_to_world(light);
  append_light<spec::PointLightSource, Quantity::luminous_intensity>({at}, light_spectrum(light, "intensity"),
                                                                     light.where(), light.importer());
}

void add_spot(const Object& light) {
  const M44d m = light_to_world(light);
  const double cutoff = light.number("cutoff_angle", 20);
  const double beam_width = light.number("beam_width", 0.75 * cutoff);
  const double half_angle =
      hard_cone(beam_width, cutoff, Falloff::linear_angle, light.where(), light.importer());
  append_light<spec::SpotLightSource, Quantity::luminous_intensity>(
      {V3d(0, 0, 0) * m, direction({0, 0, 1}, m), half_angle}, light_spectrum(light, "intensity"),
      light.where(), light.importer());
}

void add_directional(const Object& light) {
  const M44d m = light_to_world(light);
  const V3d along = light.has("direction")
                        ? direction(light.point("direction", {0, 0, 1}), light.state().world_mirror)
                        : direction({0, 0, 1}, m);
  append_light<spec::DirectionalLightSource, Quantity::illuminance>(
      {-along, {}}, light_spectrum(light, "irradiance"), light.where(), light.importer());
}

void add_environment(const Object& light) {
  append_light<spec::EnvironmentLightSource, Quantity::luminance>(
      {{}, light.where()}, light_spectrum(light, "radiance"), light.where(), light.importer());
}

// Adds an environment map, whose center is along +z with +y up before its transform.
void add_environment_image(const Object& light) {
  const auto path = light.state().folder / light.text("filename", "");
  if (!light.importer().check_file(path, light.where())) return;
  const M44d m = light_to_world(light);
  const V3d up = direction({0, 1, 0}, m).normalized();
  const V3d forward = direction({0, 0, 1}, m).normalized();
  if (mirrors(m)) light.note("mirroring of an environment image is not supported: dropped");
  const V3d reference = environment_frame(up, 0).forward;
  const double turn =
      std::atan2(reference.cross(forward).dot(up), reference.dot(forward)) * 180 / std::numbers::pi;
  const spec::EnvironmentImage image{{{light.importer().name_of(path)}, light.where()}, up, turn};
  const ImportedLightSpectrum white = light_spectrum_of(
      LinearRgb{1, 1, 1}, light.number("scale", 1) * y_integral(), light.where(), light.importer());
  append_light<spec::EnvironmentLightSource, Quantity::luminance>({image, light.where()}, white,
                                                                  light.where(), light.importer());
}

}  // namespace

void add_shape(const Object& shape, ShapeOwner owner, std::vector<spec::Shape>& shapes,
               Materials& materials) {
  if (shape.type() == "shapegroup") return (void)add_group(shape, materials);
  if (shape.type() == "instance") return add_instance(shape, materials);
  auto local = surface_of(shape);
  if (!local) return;
  ImportedShape imported;
  add_emission(shape, owner, imported);
  auto material = material_of(shape, local->v, materials);
  imported.reversed = shape.boolean("flip_normals", false);
  imported.u_is_radial = true;
  if (!local->mesh.triangles.empty()) orient_mesh(shape, local->mesh, imported);
  imported.to_world = local->matrix * shape.transform("to_world") *
                      (owner == ShapeOwner::scene ? shape.state().world_mirror : M44d());
  if (!shape.element()["id"].empty()) imported.name = shape.element()["id"];
  shape.ignore({"silhouette_sampling_weight"});
  shape.note_unused();
  if (!material && !imported.emission) return;  // There is neither a surface nor a medium.
  imported.surface = std::move(local->surface);
  imported.material = material.value_or("");
  imported.where = shape.where();
  if (!material)
    imported.material = shape.importer().add_material(
        "black", {spec::Diffuse{curve_of(0.0, imported.where, shape.importer())}, {}, {}});
  append_shape(std::move(imported), owner, shapes, shape.importer());
}

void add_light(const Object& light) {
  light.ignore({"sampling_weight"});
  const std::string& type = light.type();
  if (type == "point") {
    add_point(light);
  } else if (type == "spot") {
    add_spot(light);
  } else if (type == "directional") {
    add_directional(light);
  } else if (type == "constant") {
    add_environment(light);
  } else if (type == "envmap") {
    add_environment_image(light);
  } else if (light.importer().is_known("emitter", type, kLightTypes, light.where())) {
    light.note(fmt::format("an emitter \"{}\" is not supported: dropped", type));
    return;
  }
  light.note_unused();
}

}  // namespace abbe::importers::mitsuba

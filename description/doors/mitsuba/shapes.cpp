#include "description/doors/mitsuba/shapes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <ImathMatrixAlgo.h>
#include <fmt/format.h>

#include "description/doors/mitsuba/lights.h"
#include "description/meshes/mesh_file.h"

namespace abbe::doors::mitsuba {
namespace {

using Imath::M44d;
using Imath::V3d;
using Surface = decltype(GivenShape::surface);

const std::vector<std::string> kShapeTypes{"bsplinecurve", "cube",       "cylinder", "disk",      "instance",
                                           "linearcurve",  "obj",        "ply",      "rectangle", "sdfgrid",
                                           "serialized",   "shapegroup", "sphere"};

/// A surface, and what moves it before `to_world` does.
struct Local {
  Surface surface;
  M44d matrix{};
  RunsOfV v = RunsOfV::down;
  Mesh mesh{};  ///< What a mesh file holds.
};

/// How coordinates run on a side of a cube; the normal is along_v x along_u.
struct CubeSide {
  V3d along_u, along_v;
};
const std::array<CubeSide, 6> kCubeSides{{{{0, 1, 0}, {0, 0, -1}},
                                          {{0, 1, 0}, {0, 0, 1}},
                                          {{-1, 0, 0}, {0, 0, -1}},
                                          {{0, 0, 1}, {1, 0, 0}},
                                          {{0, 1, 0}, {1, 0, 0}},
                                          {{0, -1, 0}, {1, 0, 0}}}};

// [-1, 1] along each axis, every side with coordinates of its own.
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

// Around z from 0 to 1, with radius 1, then put between two points.
Local cylinder(const Object& shape, const World& world) {
  const V3d from = shape.point("p0", {0, 0, 0});
  const V3d to = shape.point("p1", {0, 0, 1});
  const double radius = shape.number("radius", 1);
  const V3d axis = to - from;
  world.door.note(shape.where(), "a cylinder becomes flat triangles");
  const M44d matrix = scaling({radius, radius, axis.length()}) *
                      Imath::rotationMatrix(V3d(0, 0, 1), axis.normalized()) * translation(from);
  return {swept({{1, 0}, {1, 1}}, 360), matrix};
}

// Whether triangles that share a vertex lie in different planes.
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

// Meshes without normals at their vertices are given such there, unless told otherwise.
void note_normals(const Object& shape, const MeshFile& file, const World& world) {
  const Mesh& mesh = file.submeshes.front().mesh;
  const bool flat = shape.truth("face_normals", false);
  if (flat && !mesh.normals.empty())
    world.door.note(shape.where(), "vertex normals of a mesh file are used all the same");
  if (!flat && mesh.normals.empty() && is_bent(mesh))
    world.door.note(shape.where(),
                    "a mesh file without vertex normals is not smoothed here: its triangles are seen");
}

std::optional<Local> mesh_file(const Object& shape, const World& world) {
  const auto path = world.folder / shape.text("filename", "");
  if (!world.door.take_file(path, shape.where())) return std::nullopt;
  auto file = load_mesh_file(path, FileMaterials::ignored, shape.where(), world.door.diagnostics,
                             FileCoordinates::ignored, world.door.inputs);
  if (!file) return std::nullopt;
  const bool obj = shape.type() == "obj";
  const bool turned = shape.truth("flip_tex_coords", obj);
  shape.ignore({"max_smooth_angle"});
  Local local{MeshFileSurface{path}, {}, turned ? RunsOfV::up : RunsOfV::down};
  if (file->submeshes.empty()) return local;
  note_normals(shape, *file, world);
  local.mesh = std::move(file->submeshes.front().mesh);
  return local;
}

std::optional<Local> surface_of(const Object& shape, const World& world) {
  const std::string& type = shape.type();
  if (type == "rectangle") return Local{spec::Quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, shape.where()}};
  if (type == "cube") return Local{cube()};
  if (type == "sphere")
    return Local{spec::Sphere{shape.point("center", {0, 0, 0}), shape.number("radius", 1)},
                 {},
                 RunsOfV::up};  // rows run down from +z there as here
  if (type == "disk") return Local{spec::Disc{{0, 0, 0}, {0, 0, 1}, 1}};
  if (type == "cylinder") return cylinder(shape, world);
  if (type == "obj" || type == "ply") return mesh_file(shape, world);
  if (std::ranges::find(kShapeTypes, type) == kShapeTypes.end())
    world.door.diagnostics.error(shape.where(), unknown_name("shape", type, kShapeTypes));
  else if (type == "serialized")
    world.door.diagnostics.error(
        shape.where(), "Mitsuba's own serialized meshes are not read: write PLY or OBJ", ErrorCode::input);
  else
    world.door.note(shape.where(), fmt::format("a shape \"{}\" has no counterpart here: dropped", type));
  return std::nullopt;
}

// The matter within, nullptr without any.
const Element* interior(const Object& shape, const World& world) {
  if (shape.has("exterior")) world.door.note(shape.where(), "matter outside of a shape is dropped");
  shape.ignore({"exterior"});
  return shape.find("interior", {"medium"});
}

std::optional<std::string> material_of(const Object& shape, RunsOfV v, Materials& materials,
                                       const World& world) {
  const Element* inside = interior(shape, world);
  const auto bsdfs = shape.all("bsdf");
  static const Element kDefault{"bsdf", {{"type", "diffuse"}}};
  return materials.name_of(bsdfs.empty() ? kDefault : *bsdfs.front(), inside, v);
}

// Adds a group, and gives its name.
std::string add_group(const Object& group, Materials& materials, const World& world) {
  std::string name = group.element()["id"];
  if (name.empty()) name = fmt::format("shape group {}", world.door.scene.objects.size() + 1);
  spec::Object object;
  for (const Element* member : group.all("shape"))
    add_shape(Object(*member, world), Among::object, object.shapes, materials, world);
  if (object.shapes.empty())
    world.door.diagnostics.error(group.where(), "a shape group of no shapes");
  else
    world.door.scene.objects.push_back({name, std::move(object), group.where()});
  return name;
}

// Of a group that stands within it or elsewhere in the scene.
void add_instance(const Object& shape, Materials& materials, const World& world) {
  const auto groups = shape.all("shape");
  const M44d m = shape.transform("to_world") * world.upright;
  if (groups.size() != 1 || (*groups.front())["type"] != "shapegroup")
    return world.door.diagnostics.error(shape.where(), "an instance needs one shape group");
  const Element& group = *groups.front();
  const bool is_within = std::ranges::any_of(shape.element().children,
                                             [&group](const Element& child) { return &child == &group; });
  const std::string name = is_within ? add_group(Object(group, world), materials, world) : group["id"];
  place_instance(name, m, shape.where(), world.door);
}

// Which side of a mesh file's triangles is the front there: that of their normals, of those without any what
// their order says where they stand, in a mirror too.
void turn_mesh(const Object& shape, const Mesh& mesh, GivenShape& given, const World& world) {
  if (!mesh.normals.empty() && !shape.truth("face_normals", false))
    heed_normals(mesh, given, world.door);
  else if (mirrors(shape.transform("to_world")))
    given.turned = !given.turned;
}

void add_emission(const Object& shape, Among among, GivenShape& given, const World& world) {
  const auto emitters = shape.all("emitter");
  if (emitters.empty()) return;
  const Object light(*emitters.front(), world);
  if (among == Among::object) {
    world.door.note(shape.where(), "what instances place does not emit here: its light is dropped");
    return;
  }
  given.emission = area_emission(light, world);
  light.ignore({"sampling_weight"});
  light.note_unused();
}

}  // namespace

void add_shape(const Object& shape, Among among, std::vector<spec::Shape>& shapes, Materials& materials,
               const World& world) {
  if (shape.type() == "shapegroup") return (void)add_group(shape, materials, world);
  if (shape.type() == "instance") return add_instance(shape, materials, world);
  auto local = surface_of(shape, world);
  if (!local) return;
  GivenShape given;
  add_emission(shape, among, given, world);
  auto material = material_of(shape, local->v, materials, world);
  given.turned = shape.truth("flip_normals", false);
  given.u_outwards = true;
  if (!local->mesh.triangles.empty()) turn_mesh(shape, local->mesh, given, world);
  given.to_world =
      local->matrix * shape.transform("to_world") * (among == Among::scene ? world.upright : M44d());
  if (!shape.element()["id"].empty()) given.name = shape.element()["id"];
  shape.ignore({"silhouette_sampling_weight"});
  shape.note_unused();
  if (!material && !given.emission) return;  // neither matter nor surface
  given.surface = std::move(local->surface);
  given.material = material.value_or("");
  given.where = shape.where();
  if (!material)
    given.material =
        world.door.add_material("black", {spec::Diffuse{curve_of(0.0, given.where, world.door)}, {}, {}});
  place(std::move(given), among, shapes, world.door);
}

}  // namespace abbe::doors::mitsuba

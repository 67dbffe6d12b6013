#include "description/shape.h"

#include <cstdint>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "description/light.h"
#include "description/material.h"
#include "description/meshes/mesh_file.h"
#include "description/object.h"
#include "description/surface.h"
#include "description/transform.h"
#include "description/values.h"
#include "io/schema/read.h"
#include "scene/shapes/mesh.h"

namespace abbe::description {
namespace {

Imath::V3d moved_direction(const Imath::V3d& v, const Transform& by) {
  Imath::V3d result;
  by.matrix.multDirMatrix(v, result);
  return result;
}
void move(Mesh& mesh, const Transform& by) {
  for (Imath::V3d& vertex : mesh.vertices) vertex *= by.matrix;
  for (std::array<Imath::V3f, 3>& corners : mesh.normals)
    for (Imath::V3f& normal : corners)
      normal = Imath::V3f(moved_direction(Imath::V3d(normal), by).normalized());
}
void move(Sphere& sphere, const Transform& by) {
  sphere.center *= by.matrix;
  sphere.radius *= by.scale;
}
void move(Disc& disc, const Transform& by) {
  disc.center *= by.matrix;
  disc.normal = moved_direction(disc.normal, by).normalized();
  disc.radius *= by.scale;
}
void move(Quad& quad, const Transform& by) {
  quad.corner *= by.matrix;
  quad.edge_u = moved_direction(quad.edge_u, by);
  quad.edge_v = moved_direction(quad.edge_v, by);
}

std::optional<Mesh> scaled(std::optional<Mesh> mesh, double factor) {
  if (mesh)
    for (Imath::V3d& vertex : mesh->vertices) vertex *= factor;
  return mesh;
}

// What a table reads, built.
template <typename S>
std::optional<PlainShape> read_surface(const JsonValue& json, const LoadContext& context) {
  const auto surface = schema::read<S>(json, context.diagnostics);
  if (!surface) return std::nullopt;
  auto shape = std::optional(build(*surface, context));
  if (!shape) return std::nullopt;
  return std::make_optional<PlainShape>(*std::move(shape));
}

// The parts of a mesh file, made of `material` or of the file's own.
std::vector<NamedShape> read_mesh_file(const JsonValue& json, const std::string& file,
                                       const std::string& name, const std::uint32_t* material,
                                       LoadContext& context, Scene& scene) {
  std::vector<NamedShape> parts;
  const auto path = context.file(file, json.where);
  if (!path) return parts;
  const bool mapped = material && needs_coordinates(scene.materials[*material]);
  auto found = load_mesh_file(*path, material ? FileMaterials::ignored : FileMaterials::wanted, json.where,
                              context.diagnostics,
                              mapped ? FileCoordinates::wanted : FileCoordinates::ignored, context.inputs);
  if (!found) return parts;
  for (const std::filesystem::path& other : found->others) context.remember(other);
  for (MeshFile::Submesh& part : found->submeshes) {
    context.take_memory(path->string(), memory_bytes(part.mesh));
    if (!material && !part.material) {
      context.diagnostics.error(
          json.where, fmt::format("mesh \"{}\": triangles without a material; the shape needs one", file));
      return {};
    }
    const std::string full =
        found->submeshes.size() == 1 ? name : name + "/" + found->materials[*part.material].name;
    NamedShape& added =
        parts.emplace_back(NamedShape{full, *scaled(std::move(part.mesh), context.unit_m), 0});
    if (material)
      added.material = *material;
    else
      added.material = add_file_material(found->materials[*part.material], file, json, context, scene);
  }
  return parts;
}

std::string mesh_name(const std::string* file) {
  return file ? fmt::format("mesh \"{}\"", *file) : "the mesh";
}

// Reports a mesh without the texture coordinates that its material needs.
void require_coordinates(std::span<const NamedShape> parts, const Material& material, const JsonValue& json,
                         const std::string* file, const LoadContext& context) {
  if (!needs_coordinates(material)) return;
  for (const NamedShape& part : parts)
    if (const auto* mesh = std::get_if<Mesh>(&part.shape); mesh && mesh->coordinates.empty())
      context.diagnostics.error(json.where,
                                fmt::format("{}: no texture coordinates, which its material \"{}\" needs",
                                            mesh_name(file), material.name),
                                file ? ErrorCode::input : ErrorCode::scene);
}

// The shape of the kind `key` before its transform.
std::vector<NamedShape> read_unplaced(ObjectReader& reader, std::string_view key, const std::string& name,
                                      LoadContext& context, Scene& scene) {
  const JsonValue& json = *reader.find(key);
  if (key == "chart") return read_chart(json, name, context, scene);
  const auto* file = key == "mesh" ? std::get_if<std::string>(&json.value) : nullptr;
  const bool optional = file && brings_materials(*file);
  const JsonValue* material_name = optional ? reader.find("material") : reader.require("material");
  const auto material = material_name ? find_material(*material_name, context, scene) : std::nullopt;
  std::vector<NamedShape> parts;
  if (file && (material || !material_name)) {
    parts = read_mesh_file(json, *file, name, material ? &*material : nullptr, context, scene);
  } else if (!file) {
    auto shape = read_geometry(json, key, context);
    if (shape && material) parts.push_back({name, std::move(*shape), *material});
  }
  if (material) require_coordinates(parts, scene.materials[*material], json, file, context);
  if (key == "mesh")
    for (NamedShape& part : parts)
      prepare_for_medium(std::get<Mesh>(part.shape), mesh_name(file), scene.materials[part.material],
                         json.where, context);
  return parts;
}

void read_shape(const JsonValue& json, std::size_t number, LoadContext& context, Scene& scene) {
  ObjectReader reader(json, context.diagnostics);
  std::string name = reader.string("name").value_or(fmt::format("shape {}", number));
  const auto key = reader.exactly_one({"mesh", "sphere", "disc", "quad", "prism", "chart", "instance"});
  if (!key) return;
  if (*key == "instance") {
    add_instance(*reader.find(*key), name, context, scene);
    reader.finish();
    return;
  }
  std::vector<NamedShape> parts = read_named_shapes(reader, *key, name, context, scene);
  if (*key == "chart" && !parts.empty())
    scene.charts.push_back({name, static_cast<std::uint32_t>(scene.shapes.size()),
                            static_cast<std::uint32_t>(parts.size() - 1)});
  const JsonValue* emission = reader.find("emission");
  const bool two_sided = reader.boolean_or("two_sided", false);
  reader.finish();
  if (emission && !reader.find("material"))
    context.diagnostics.error(emission->where, "a shape that emits needs a material of its own");
  for (NamedShape& part : parts) {
    scene.shapes.push_back({std::move(part.name), as_shape(std::move(part.shape)), part.material});
    if (emission)
      add_area_light(*emission, two_sided, static_cast<std::uint32_t>(scene.shapes.size() - 1), context,
                     scene);
  }
}

}  // namespace

Shape as_shape(PlainShape shape) {
  return std::visit([](auto& plain) { return Shape(std::move(plain)); }, shape);
}

void shift(Mesh& mesh, const Imath::V3d& by) {
  for (Imath::V3d& vertex : mesh.vertices) vertex += by;
}
void shift(Sphere& sphere, const Imath::V3d& by) {
  sphere.center += by;
}
void shift(Disc& disc, const Imath::V3d& by) {
  disc.center += by;
}
void shift(Quad& quad, const Imath::V3d& by) {
  quad.corner += by;
}
void shift(PlacedShape&, const Imath::V3d&) {}

std::optional<Imath::V3d> read_point(ObjectReader& reader, std::string_view key, const LoadContext& context) {
  const auto v = reader.require_numbers(key, 3, kCoordinate);
  if (!v) return std::nullopt;
  return Imath::V3d((*v)[0], (*v)[1], (*v)[2]) * context.unit_m;
}

std::optional<Imath::V3d> read_direction(ObjectReader& reader, std::string_view key,
                                         const LoadContext& context) {
  const auto v = reader.require_numbers(key, 3, kCoordinate);
  if (!v) return std::nullopt;
  const Imath::V3d direction((*v)[0], (*v)[1], (*v)[2]);
  if (direction.length() > 0) return direction.normalized();
  context.diagnostics.error(reader.find(key)->where, "a direction must not be zero (got [0, 0, 0])");
  return std::nullopt;
}

std::vector<NamedShape> read_named_shapes(ObjectReader& reader, std::string_view key, const std::string& name,
                                          LoadContext& context, Scene& scene) {
  std::vector<NamedShape> parts = read_unplaced(reader, key, name, context, scene);
  const JsonValue* steps = reader.find("transform");
  std::vector<spec::Similarity> moves;
  if (steps) (void)schema::read(*steps, spec::similarity_steps(), &moves, context.diagnostics);
  const Transform transform = build(moves, context);
  for (NamedShape& part : parts) std::visit([&](auto& s) { move(s, transform); }, part.shape);
  return parts;
}

std::optional<PlainShape> read_geometry(const JsonValue& json, std::string_view key, LoadContext& context) {
  if (key == "mesh") return read_surface<spec::InlineMesh>(json, context);
  if (key == "sphere") return read_surface<spec::Sphere>(json, context);
  if (key == "disc") return read_surface<spec::Disc>(json, context);
  if (key == "quad") return read_surface<spec::Quad>(json, context);
  return read_surface<spec::Prism>(json, context);
}

void read_shapes(const JsonValue& json, LoadContext& context, Scene& scene) {
  const JsonValue::Array* list = read_array(json, "shapes", 0, context.diagnostics);
  if (!list) return;
  for (std::size_t i = 0; i < list->size(); ++i) {
    read_shape((*list)[i], i, context, scene);
    context.shape_places.resize(scene.shapes.size(), (*list)[i].where);
  }
}

}  // namespace abbe::description

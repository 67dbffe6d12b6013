#include "description/shape.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "description/light.h"
#include "description/material.h"
#include "description/meshes/mesh_file.h"
#include "scene/shapes/mesh.h"
#include "scene/shapes/placed.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr char kTransform[] = "Where the shape is moved, by steps in order.";

Kind mesh() {
  return forms<Mesh::Wrapped>("mesh", "a mesh: the name of a file, or triangles",
                              form<std::string>(Json::text), form<MeshPart>(Json::object, {"file"}),
                              form<InlineMesh>(Json::object));
}

}  // namespace

static Fields fields(Tag<MeshPart>) {
  return describe(
      "mesh_part", "The triangles of a mesh file that are made of one of its own materials.",
      {field("file", &MeshPart::file, "An OBJ, glTF 2.0 or GLB file."),
       field("of_material", &MeshPart::of_material,
             "The name of that material in the file; `material N`, which counts from 0, where glTF "
             "gives none, `default` where it names no material.")});
}

template <typename Surface, typename Material, typename Emission>
Fields fields(Tag<Body<Surface, Material, Emission>>) {
  using B = Body<Surface, Material, Emission>;
  Field surface;
  if constexpr (std::is_same_v<Surface, Mesh>)
    surface = field("mesh", &B::surface, mesh(),
                    "A PLY (as .ply.gz too), OBJ, glTF 2.0 or GLB file, or triangles.");
  else
    surface = field(fields_of<Surface>().name, &B::surface);
  return describe(
      "", "",
      {std::move(surface),
       field("material", &B::material,
             std::is_same_v<Surface, Mesh> ? "Name of its material; an OBJ or glTF file may bring its own."
                                           : "Name of its material."),
       defaulted("transform", &B::transform, similarity_steps(), kTransform),
       field("emission", &B::emission, "What its surface sends out."),
       defaulted("two_sided", &B::two_sided, "Whether it emits from both sides.")});
}

static Fields fields(Tag<Chart>) {
  return describe(
      "chart", "A colour chart: six patches a row, from the top left, on a dark surround.",
      {field("reflectances", &Chart::reflectances,
             "A table of data/reflectance, or FILE.csv: a patch per column."),
       field("corner", &Chart::corner, kCoordinate, "Position of its lower left, as the reader sees it."),
       field("edge_u", &Chart::edge_u, kCoordinate, "Along the rows."),
       field("edge_v", &Chart::edge_v, kCoordinate, "Upwards."),
       field("surround", &Chart::surround, "Reflectance of its surround, 0.035 when absent.")});
}
static Fields fields(Tag<ChartShape>) {
  return describe("chart_shape", "",
                  {field("chart", &ChartShape::chart),
                   defaulted("transform", &ChartShape::transform, similarity_steps(), kTransform)});
}

static Fields fields(Tag<Instance>) {
  return describe("instance", "An object placed in the scene.",
                  {field("of", &Instance::of, "Name of the object."),
                   defaulted("transform", &Instance::transform, affine_steps(),
                             "Where it is placed, by steps in order.")});
}

Fields fields(Tag<Shape>) {
  return describe(
      "shape", "A shape.",
      {field("name", &Shape::name, "For messages, and to name it as a white if it emits."),
       one_of(&Shape::kind, beside<MeshBody>("mesh"), beside<PlainBody<Sphere>>("sphere"),
              beside<PlainBody<Disc>>("disc"), beside<PlainBody<Quad>>("quad"), beside<PrismBody>("prism"),
              beside<ChartShape>("chart"), under<Instance>("instance")),
       field("motion", &Shape::motion, "How it moves, from where it is described; a chart does not.")});
}

Fields fields(Tag<Object>) {
  return describe("object", "Shapes that appear only where an instance puts them.",
                  {field("shapes", &Object::shapes, list<Shape>("shapes", 1),
                         "Its shapes, of which none is an instance or a chart, and none emits.")});
}

}  // namespace abbe::spec

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

// The parts of a mesh file, made of `material` or of the file's own.
std::vector<NamedShape> build_mesh_file(const SourcePosition& where, const std::string& file,
                                        const std::string& name, const std::uint32_t* material,
                                        LoadContext& context, Scene& scene) {
  std::vector<NamedShape> parts;
  const auto path = context.file(file, where);
  if (!path) return parts;
  const bool mapped = material && needs_coordinates(scene.materials[*material]);
  auto found = load_mesh_file(*path, material ? FileMaterials::ignored : FileMaterials::wanted, where,
                              context.diagnostics,
                              mapped ? FileCoordinates::wanted : FileCoordinates::ignored, context.inputs);
  if (!found) return parts;
  for (const std::filesystem::path& other : found->others) context.remember(other);
  for (MeshFile::Submesh& part : found->submeshes) {
    context.take_memory(path->string(), memory_bytes(part.mesh));
    if (!material && !part.material) {
      context.diagnostics.error(
          where, fmt::format("mesh \"{}\": triangles without a material; the shape needs one", file));
      return {};
    }
    const std::string full =
        found->submeshes.size() == 1 ? name : name + "/" + found->materials[*part.material].name;
    NamedShape& added =
        parts.emplace_back(NamedShape{full, *scaled(std::move(part.mesh), context.unit_m), 0});
    if (material)
      added.material = *material;
    else
      added.material = add_file_material(found->materials[*part.material], file, where, context, scene);
  }
  return parts;
}

// The triangles of a file that it makes of one of its materials, made of `material`.
std::vector<NamedShape> build_mesh_part(const spec::MeshPart& part, const std::string& name,
                                        std::uint32_t material, LoadContext& context, Scene& scene) {
  std::vector<NamedShape> parts;
  const auto path = context.file(part.file.value, part.file.where);
  if (!path) return parts;
  auto found = load_mesh_file(
      *path, FileMaterials::named, part.file.where, context.diagnostics,
      needs_coordinates(scene.materials[material]) ? FileCoordinates::wanted : FileCoordinates::ignored,
      context.inputs);
  if (!found) return parts;
  for (const std::filesystem::path& other : found->others) context.remember(other);
  std::vector<std::string> names;
  for (MeshFile::Submesh& submesh : found->submeshes) {
    if (!submesh.material) continue;
    names.push_back(found->materials[*submesh.material].name);
    if (names.back() != part.of_material.value) continue;
    context.take_memory(path->string(), memory_bytes(submesh.mesh));
    parts.push_back({name, *scaled(std::move(submesh.mesh), context.unit_m), material});
  }
  if (parts.empty())
    context.diagnostics.error(part.of_material.where,
                              unknown_name("material of the mesh file", part.of_material.value, names),
                              ErrorCode::input);
  return parts;
}

std::string mesh_name(const std::string* file) {
  return file ? fmt::format("mesh \"{}\"", *file) : "the mesh";
}

// Reports a mesh without the texture coordinates that its material needs.
void require_coordinates(std::span<const NamedShape> parts, const Material& material,
                         const SourcePosition& where, const std::string* file, const LoadContext& context) {
  if (!needs_coordinates(material)) return;
  for (const NamedShape& part : parts)
    if (const auto* mesh = std::get_if<Mesh>(&part.shape); mesh && mesh->coordinates.empty())
      context.diagnostics.error(where,
                                fmt::format("{}: no texture coordinates, which its material \"{}\" needs",
                                            mesh_name(file), material.name),
                                file ? ErrorCode::input : ErrorCode::scene);
}

/// The parts of each kind of shape before its transform.
struct PartsBuilder {
  const SourcePosition& where;
  const std::string& name;
  LoadContext& context;
  Scene& scene;

  std::vector<NamedShape> operator()(std::monostate) const { return {}; }
  std::vector<NamedShape> operator()(const spec::Instance&) const { return {}; }
  std::vector<NamedShape> operator()(const spec::ChartShape& said) const {
    return build(said.chart, name, context, scene);
  }
  template <typename Surface, typename Emission>
  std::vector<NamedShape> operator()(const spec::Body<Surface, spec::MaterialName, Emission>& said) const {
    std::optional surface = build(said.surface, context);
    const auto material = find_material(said.material, context, scene);
    std::vector<NamedShape> parts;
    if (surface && material) parts.push_back({name, *std::move(surface), *material});
    return parts;
  }
  std::vector<NamedShape> operator()(const spec::MeshBody& said) const {
    const SourcePosition& at = said.surface.where;
    const auto* part = std::get_if<spec::MeshPart>(&said.surface.value);
    const auto* file = part ? &part->file.value : std::get_if<std::string>(&said.surface.value);
    if (!said.material && !(file && !part && brings_materials(*file))) {
      context.diagnostics.error(where, "missing key \"material\"");
      return {};
    }
    const auto material = said.material ? find_material(*said.material, context, scene) : std::nullopt;
    std::vector<NamedShape> parts;
    if (part && material)
      parts = build_mesh_part(*part, name, *material, context, scene);
    else if (file && !part && (material || !said.material))
      parts = build_mesh_file(at, *file, name, material ? &*material : nullptr, context, scene);
    else if (!file)
      if (auto mesh = build(std::get<spec::InlineMesh>(said.surface.value), context); mesh && material)
        parts.push_back({name, *std::move(mesh), *material});
    if (material) require_coordinates(parts, scene.materials[*material], at, file, context);
    for (NamedShape& part : parts)
      prepare_for_medium(std::get<Mesh>(part.shape), mesh_name(file), scene.materials[part.material], at,
                         context);
    return parts;
  }
};

bool emits_from_both_sides(const spec::Shape& shape) {
  const auto both = [](const auto& kind) {
    if constexpr (requires { kind.two_sided; })
      return kind.two_sided;
    else
      return false;
  };
  return std::visit(both, shape.kind);
}

void add_shape(const spec::Shape& shape, const std::string& name, LoadContext& context, Scene& scene) {
  if (const auto* instance = std::get_if<spec::Instance>(&shape.kind))
    return add_instance(*instance, build(shape.motion, context), name, context, scene);
  std::vector<NamedShape> parts = build_parts(shape, name, context, scene);
  if (shape.motion && std::holds_alternative<spec::ChartShape>(shape.kind))
    context.diagnostics.error(shape.motion->where, "a chart does not move");
  const Moving moving = build(shape.motion, context);
  if (std::holds_alternative<spec::ChartShape>(shape.kind) && !parts.empty())
    scene.charts.push_back({name, static_cast<std::uint32_t>(scene.shapes.size()),
                            static_cast<std::uint32_t>(parts.size() - 1)});
  const spec::Emission* emission = emission_of(shape);
  const auto* mesh = std::get_if<spec::MeshBody>(&shape.kind);
  if (emission && mesh && !mesh->material)
    context.diagnostics.error(emission->where, "a shape that emits needs a material of its own");
  for (NamedShape& part : parts) {
    scene.shapes.push_back({std::move(part.name),
                            in_motion(std::move(part.shape), emission != nullptr,
                                      scene.materials[part.material], moving, context),
                            part.material});
    if (emission)
      add_area_light(*emission, emits_from_both_sides(shape),
                     static_cast<std::uint32_t>(scene.shapes.size() - 1), context, scene);
  }
}

// True if the moved shape alone no longer shows where the axes of its description are: it is round and
// turned, or it holds a grid of densities.
bool loses_axes(const PlainShape& shape, const Material& material, const Imath::M44d& to) {
  const Medium* medium = abbe::medium(material);
  if (medium != nullptr && medium->grid) return to != Imath::M44d();
  const bool round = std::holds_alternative<Sphere>(shape) || std::holds_alternative<Disc>(shape);
  return round && to != Imath::M44d().setTranslation(to.translation());
}

}  // namespace

// What moves is a prototype around its middle, where floats are finest; so is what has been turned and could
// not tell it otherwise.
abbe::Shape in_motion(PlainShape shape, bool emits, const Material& material, const Moving& moving,
                      LoadContext& context) {
  if (!moving.motion && (emits || !loses_axes(shape, material, moving.opening))) {
    if (moving.opening != Imath::M44d())
      std::visit([&](auto& s) { move(s, Transform{moving.opening}); }, shape);
    return std::visit([](auto& s) { return abbe::Shape(std::move(s)); }, shape);
  }
  const Imath::V3d center = std::visit([](const auto& s) { return bounds(s); }, shape).center();
  std::visit([&](auto& s) { shift(s, -center); }, shape);
  const auto at =
      std::make_shared<Placement>(placement(Imath::M44d().setTranslation(center) * moving.opening));
  at->motion = moving.motion;
  at->described_origin = center;
  context.placements.push_back(at);
  return PlacedShape{make_prototype(std::move(shape)), at};
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

const spec::Emission* emission_of(const spec::Shape& shape) {
  const auto emission = [](const auto& kind) -> const spec::Emission* {
    if constexpr (requires { kind.emission; })
      return kind.emission ? &*kind.emission : nullptr;
    else
      return nullptr;
  };
  return std::visit(emission, shape.kind);
}

std::vector<NamedShape> build_parts(const spec::Shape& shape, const std::string& name, LoadContext& context,
                                    Scene& scene) {
  std::vector<NamedShape> parts = std::visit(PartsBuilder{shape.where, name, context, scene}, shape.kind);
  const auto place = [&](const auto& kind) {
    if constexpr (requires { build(kind.transform, context).scale; }) {
      if (kind.transform.empty()) return;
      const Transform transform = build(kind.transform, context);
      for (NamedShape& part : parts) std::visit([&](auto& s) { move(s, transform); }, part.shape);
    }
  };
  std::visit(place, shape.kind);
  return parts;
}

void build_shapes(const std::vector<spec::Shape>& shapes, LoadContext& context, Scene& scene) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    add_shape(shapes[i], shapes[i].name.value_or(fmt::format("shape {}", i)), context, scene);
    context.shape_places.resize(scene.shapes.size(), shapes[i].where);
  }
}

}  // namespace abbe::description

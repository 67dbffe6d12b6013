#include "description/shape.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/light.h"
#include "description/material.h"
#include "description/meshes/mesh_file.h"
#include "scene/shapes/shape.h"
#include "scene/shapes/solid.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr char kTransform[] = "Transform of the shape, in steps.";

ValueType mesh() {
  return forms<Mesh::Wrapped>("mesh", "a mesh: the name of a file, or triangles",
                              form<std::string>(Json::text), form<MeshPart>(Json::object, {"file"}),
                              form<InlineMesh>(Json::object));
}

}  // namespace

static Fields fields(Tag<MeshPart>) {
  return describe("mesh_part", "The triangles of a mesh file that use one of its own materials.",
                  {field("file", &MeshPart::file, "An OBJ, glTF 2.0 or GLB file."),
                   field("of_material", &MeshPart::of_material,
                         "Name of that material in the file. Unnamed materials of glTF are `material N`, "
                         "counted from 0; triangles without a material are `default`.")});
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
             std::is_same_v<Surface, Mesh>
                 ? "Name of its material; optional for OBJ and glTF files, which may contain their own."
                 : "Name of its material."),
       defaulted("transform", &B::transform, similarity_steps(), kTransform),
       field("emission", &B::emission, "Emission of its surface."),
       defaulted("two_sided", &B::two_sided, "True to emit from both sides.")});
}

static Fields fields(Tag<Chart>) {
  return describe("chart", "A colour chart: six patches a row, from the top left, on a dark surround.",
                  {field("reflectances", &Chart::reflectances,
                         "A table of data/reflectance, or FILE.csv, with one patch per column."),
                   field("corner", &Chart::corner, kCoordinate,
                         "Position of the lower left corner as seen by the reader."),
                   field("edge_u", &Chart::edge_u, kCoordinate, "Edge along the rows."),
                   field("edge_v", &Chart::edge_v, kCoordinate, "Edge upwards."),
                   field("surround", &Chart::surround, "Reflectance of the surround; 0.035 if absent.")});
}
static Fields fields(Tag<ChartShape>) {
  return describe("chart_shape", "",
                  {field("chart", &ChartShape::chart),
                   defaulted("transform", &ChartShape::transform, similarity_steps(), kTransform)});
}

static Fields fields(Tag<Instance>) {
  return describe(
      "instance", "An object placed in the scene.",
      {field("of", &Instance::of, "Name of the object."),
       defaulted("transform", &Instance::transform, affine_steps(), "Placement of the object, in steps.")});
}

// The key of a surface is the name of its table.
template <typename... Plain, typename... Solid>
static Field kinds_of_shape(Tag<std::variant<Plain...>>, Tag<std::variant<Solid...>>) {
  return one_of(&Shape::kind, inlined_by<MeshBody>("mesh"),
                inlined_by<PlainBody<Plain>>(fields_of<Plain>().name)...,
                inlined_by<SolidBody<Solid>>(fields_of<Solid>().name)..., inlined_by<ChartShape>("chart"),
                under<Instance>("instance"));
}

Fields fields(Tag<Shape>) {
  return describe(
      "shape", "A shape.",
      {field("name", &Shape::name, "Name for messages, and for references to it as a white if it emits."),
       kinds_of_shape(Tag<PlainSurface>(), Tag<SolidSurface>()),
       field("motion", &Shape::motion, "Motion relative to the described pose; a chart cannot move.")});
}

Fields fields(Tag<Object>) {
  return describe("object", "Shapes that appear only where an instance puts them.",
                  {field("shapes", &Object::shapes, list<Shape>("shapes", 1),
                         "Its shapes. Instances, charts and emitters are not allowed.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

std::optional<Mesh> scaled(std::optional<Mesh> mesh, double factor) {
  if (mesh)
    for (Imath::V3d& vertex : mesh->vertices) vertex *= factor;
  return mesh;
}

// Parts of a mesh file, with `material` or, if that is null, with the materials of the file.
std::vector<NamedShape> build_mesh_file(const SourcePosition& where, const std::string& file,
                                        const std::string& name, const std::uint32_t* material,
                                        LoadContext& context, Scene& scene) {
  std::vector<NamedShape> parts;
  const auto path = context.file(file, where);
  if (!path) return parts;
  const bool mapped = material && needs_coordinates(scene.materials[*material]);
  auto mesh_file = load_mesh_file(
      *path, material ? FileMaterials::ignored : FileMaterials::wanted, where, context.diagnostics,
      mapped ? FileCoordinates::wanted : FileCoordinates::ignored, context.inputs);
  if (!mesh_file) return parts;
  for (const std::filesystem::path& other : mesh_file->others) context.remember(other);
  for (MeshFile::Submesh& part : mesh_file->submeshes) {
    context.take_memory(path->string(), memory_bytes(part.mesh));
    if (!material && !part.material) {
      context.diagnostics.error(
          where, fmt::format("mesh \"{}\": triangles without a material; the shape needs one", file));
      return {};
    }
    const std::string full =
        mesh_file->submeshes.size() == 1 ? name : name + "/" + mesh_file->materials[*part.material].name;
    NamedShape& added =
        parts.emplace_back(NamedShape{full, *scaled(std::move(part.mesh), context.unit_m), 0});
    if (material)
      added.material = *material;
    else
      added.material = add_file_material(mesh_file->materials[*part.material], file, where, context, scene);
  }
  return parts;
}

// The triangles of a file that use one of its materials, with `material` in the scene.
std::vector<NamedShape> build_mesh_part(const spec::MeshPart& part, const std::string& name,
                                        std::uint32_t material, LoadContext& context, Scene& scene) {
  std::vector<NamedShape> parts;
  const auto path = context.file(part.file.value, part.file.where);
  if (!path) return parts;
  auto mesh_file = load_mesh_file(
      *path, FileMaterials::named, part.file.where, context.diagnostics,
      needs_coordinates(scene.materials[material]) ? FileCoordinates::wanted : FileCoordinates::ignored,
      context.inputs);
  if (!mesh_file) return parts;
  for (const std::filesystem::path& other : mesh_file->others) context.remember(other);
  std::vector<std::string> names;
  for (MeshFile::Submesh& submesh : mesh_file->submeshes) {
    if (!submesh.material) continue;
    names.push_back(mesh_file->materials[*submesh.material].name);
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

// Reports a mesh that lacks the texture coordinates its material needs.
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

/// Builds the parts of each kind of shape, before its transform.
struct PartsBuilder {
  const SourcePosition& where;
  const std::string& name;
  LoadContext& context;
  Scene& scene;

  std::vector<NamedShape> operator()(std::monostate) const { return {}; }
  std::vector<NamedShape> operator()(const spec::Instance&) const { return {}; }
  std::vector<NamedShape> operator()(const spec::ChartShape& spec) const {
    return build(spec.chart, name, context, scene);
  }
  template <typename Surface, typename Emission>
  std::vector<NamedShape> operator()(const spec::Body<Surface, spec::MaterialName, Emission>& spec) const {
    std::optional surface = build(spec.surface, context);
    const auto material = find_material(spec.material, context, scene);
    std::vector<NamedShape> parts;
    if (surface && material) parts.push_back({name, *std::move(surface), *material});
    return parts;
  }
  std::vector<NamedShape> operator()(const spec::MeshBody& spec) const {
    const SourcePosition& at = spec.surface.where;
    const auto* part = std::get_if<spec::MeshPart>(&spec.surface.value);
    const auto* file = part ? &part->file.value : std::get_if<std::string>(&spec.surface.value);
    if (!spec.material && !(file && !part && may_have_materials(*file))) {
      context.diagnostics.error(where, "missing key \"material\"");
      return {};
    }
    const auto material = spec.material ? find_material(*spec.material, context, scene) : std::nullopt;
    std::vector<NamedShape> parts;
    if (part && material)
      parts = build_mesh_part(*part, name, *material, context, scene);
    else if (file && !part && (material || !spec.material))
      parts = build_mesh_file(at, *file, name, material ? &*material : nullptr, context, scene);
    else if (!file)
      if (auto mesh = build(std::get<spec::InlineMesh>(spec.surface.value), context); mesh && material)
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
    context.diagnostics.error(shape.motion->where, "a chart cannot move");
  const PoseAndMotion moving = build(shape.motion, context);
  if (std::holds_alternative<spec::ChartShape>(shape.kind) && !parts.empty())
    scene.charts.push_back({name, static_cast<std::uint32_t>(scene.shapes.size()),
                            static_cast<std::uint32_t>(parts.size() - 1)});
  const spec::Emission* emission = emission_of(shape);
  const auto* mesh = std::get_if<spec::MeshBody>(&shape.kind);
  if (emission && mesh && !mesh->material)
    context.diagnostics.error(emission->where, "an emitting shape needs its own material");
  for (NamedShape& part : parts) {
    scene.shapes.push_back({std::move(part.name),
                            shape_at_opening(std::move(part.shape), emission != nullptr,
                                             scene.materials[part.material], moving, context),
                            part.material});
    if (emission)
      add_area_light(*emission, emits_from_both_sides(shape),
                     static_cast<std::uint32_t>(scene.shapes.size() - 1), context, scene);
  }
}

// True if the geometry of the moved shape no longer determines the axes of its description: it is round and
// rotated, or its medium has a grid of densities.
bool loses_axes(const PlainShape& shape, const Material& material, const Imath::M44d& to) {
  const Medium* medium = abbe::medium(material);
  if (medium != nullptr && medium->grid) return to != Imath::M44d();
  const bool round =
      std::visit([](const auto& s) { return !Triangulated<std::decay_t<decltype(s)>>; }, shape);
  return round && to != Imath::M44d().setTranslation(to.translation());
}

using Counts = std::vector<std::pair<std::size_t, const char*>>;

// Text such as "2 open edges, 1 triangle back to back with another". "(s)" in a text marks the plural ending.
std::string counted(const Counts& counts) {
  std::vector<std::string> words;
  for (const auto& [count, what] : counts) {
    if (count == 0) continue;
    std::string named = what;
    const std::size_t plural = named.find("(s)");
    named.replace(plural, 3, count == 1 ? "" : "s");
    words.push_back(fmt::format("{} {}", count, named));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

// Repairs a mesh around a medium as far as possible, and reports the rest.
void enclose_medium(Mesh& mesh, const std::string& name, const Material& material,
                    const SourcePosition& where, const LoadContext& context) {
  Diagnostics& diagnostics = context.diagnostics;
  const std::string within = fmt::format("{} around medium \"{}\"", name, material.name);
  const SolidReport solid = make_solid(mesh);
  if (solid.repaired())
    diagnostics.warning(where, fmt::format("{}: repaired: {}", within,
                                           counted({{solid.repeated, "repeated triangle(s)"},
                                                    {solid.rewound, "triangle(s) wound against the rest"},
                                                    {solid.inverted, "component(s) facing inward"}})));
  if (!solid.encloses())
    diagnostics.error_if_strict(
        where, fmt::format(
                   "{} is not a closed surface: {}", within,
                   counted({{solid.open_edges, "open edge(s)"},
                            {solid.crowded_edges, "edge(s) of more than two triangles that cannot be paired"},
                            {solid.clashing_edges, "edge(s) with opposite windings"},
                            {solid.back_to_back, "triangle(s) back to back with another"},
                            {solid.buried, "component(s) facing outward inside the medium"}})));
  if (!mesh.normals.empty() && !is_boundary(material))
    diagnostics.error_if_strict(
        where, fmt::format("{}: vertex normals are ignored, because light is refracted at the flat triangles",
                           within));
  mesh.normals = {};
}

void build_object_shape(const spec::Shape& shape, const std::string& name, LoadContext& context, Scene& scene,
                        std::vector<NamedShape>& parts) {
  if (const auto* instance = std::get_if<spec::Instance>(&shape.kind))
    return context.diagnostics.error(instance->where, "an object holds shapes, not instances");
  if (const auto* chart = std::get_if<spec::ChartShape>(&shape.kind))
    return context.diagnostics.error(chart->chart.where, "an object holds shapes, not charts");
  if (const spec::Emission* emission = emission_of(shape))
    context.diagnostics.error(emission->where, "a shape of an object cannot emit");
  if (shape.motion)
    context.diagnostics.error(shape.motion->where, "a shape of an object cannot move, but its instances can");
  for (NamedShape& part : build_parts(shape, name, context, scene)) parts.push_back(std::move(part));
}

// Prototypes of the parts, shifted to the center of the object, where single precision resolves best.
Object centred(std::vector<NamedShape> parts) {
  Imath::Box3d box;
  for (const NamedShape& part : parts)
    std::visit([&](const auto& shape) { box.extendBy(bounds(shape)); }, part.shape);
  Object object{{}, box.isEmpty() ? Imath::V3d(0) : box.center()};
  for (NamedShape& part : parts) {
    std::visit([&](auto& shape) { shift(shape, -object.center); }, part.shape);
    object.parts.push_back({std::move(part.name), part.material, make_prototype(std::move(part.shape))});
  }
  return object;
}

}  // namespace

// A moving shape becomes a prototype around its center, where single precision resolves best. So does a
// rotated shape whose geometry would lose its axes.
abbe::Shape shape_at_opening(PlainShape shape, bool emits, const Material& material,
                             const PoseAndMotion& moving, LoadContext& context) {
  if (!moving.motion && (emits || !loses_axes(shape, material, moving.pose_at_opening))) {
    if (moving.pose_at_opening != Imath::M44d())
      std::visit([&](auto& s) { transform(s, moving.pose_at_opening, 1); }, shape);
    return std::visit([](auto& s) { return abbe::Shape(std::move(s)); }, shape);
  }
  const Imath::V3d center = std::visit([](const auto& s) { return bounds(s); }, shape).center();
  std::visit([&](auto& s) { shift(s, -center); }, shape);
  const auto at =
      std::make_shared<Placement>(placement(Imath::M44d().setTranslation(center) * moving.pose_at_opening));
  at->motion = moving.motion;
  at->described_origin = center;
  context.placements.push_back(at);
  return PlacedShape{make_prototype(std::move(shape)), at};
}

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
  const auto apply_transform = [&](const auto& kind) {
    if constexpr (requires { build(kind.transform, context).scale; }) {
      if (kind.transform.empty()) return;
      const Transform by = build(kind.transform, context);
      for (NamedShape& part : parts)
        std::visit([&](auto& s) { transform(s, by.matrix, by.scale); }, part.shape);
    }
  };
  std::visit(apply_transform, shape.kind);
  return parts;
}

void build_shapes(const std::vector<spec::Shape>& shapes, LoadContext& context, Scene& scene) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    add_shape(shapes[i], shapes[i].name.value_or(fmt::format("shape {}", i)), context, scene);
    context.shape_positions.resize(scene.shapes.size(), shapes[i].where);
  }
}

void prepare_for_medium(Mesh& mesh, const std::string& name, const Material& material,
                        const SourcePosition& where, const LoadContext& context) {
  if (encloses_medium(material))
    enclose_medium(mesh, name, material, where, context);
  else
    mesh.slivers = {};  // Only closed meshes need their zero-area triangles.
}

void build_objects(const std::vector<schema::Named<spec::Object>>& objects, LoadContext& context,
                   Scene& scene) {
  for (const auto& [name, object, where] : objects) {
    std::vector<NamedShape> parts;
    for (std::size_t i = 0; i < object.shapes.size(); ++i)
      build_object_shape(object.shapes[i], object.shapes[i].name.value_or(fmt::format("shape {}", i)),
                         context, scene, parts);
    context.objects.emplace(name, centred(std::move(parts)));
  }
}

void add_instance(const spec::Instance& instance, const PoseAndMotion& moving, const std::string& name,
                  LoadContext& context, Scene& scene) {
  const auto matrix = build(instance.transform.value, instance.transform.where, context);
  if (!matrix) return;
  const auto found = context.objects.find(instance.of.value);
  if (found == context.objects.end()) {
    std::vector<std::string> names;
    for (const auto& [known, object] : context.objects) names.push_back(known);
    context.diagnostics.error(instance.of.where, unknown_name("object", instance.of.value, names));
    return;
  }
  const Object& object = found->second;
  const auto at = std::make_shared<Placement>(
      placement(Imath::M44d().setTranslation(object.center) * *matrix * moving.pose_at_opening));
  at->motion = moving.motion;
  at->described_origin = object.center;
  context.placements.push_back(at);
  for (const Object::Member& member : object.parts)
    scene.shapes.push_back({object.parts.size() == 1 ? name : name + "/" + member.name,
                            PlacedShape{member.prototype, at}, member.material});
}

}  // namespace abbe::description

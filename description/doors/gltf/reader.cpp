#include "description/doors/gltf/reader.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <ImathBox.h>
#include <ImathQuat.h>
#include <fmt/format.h>

#include "description/doors/gltf/materials.h"
#include "description/doors/shared/camera.h"
#include "description/doors/shared/lamps.h"
#include "description/doors/shared/placement.h"
#include "description/meshes/mesh_file.h"
#include "sampling/angle.h"
#include "spectral/colorimetry.h"

namespace abbe::doors {
namespace gltf {
namespace {

using Imath::M44d;
using Imath::V3d;
using spec::Quantity;

/// A camera and where it stands.
struct View {
  const JsonValue* camera;
  M44d map;
};

/// What the nodes of the scene place.
struct Placed {
  std::set<std::optional<std::size_t>> materials{};
  std::vector<View> views{};
};

bool is_perspective(const View& view) {
  return text(view.camera, "type", "perspective") == "perspective";
}

// Scale, then rotation, then translation, or the matrix, whose columns the format lists.
M44d local_map(const JsonValue& node, const Document& document) {
  if (const auto m = numbers(&node, "matrix", 16, document)) return from_rows(*m).transposed();
  M44d map;
  if (const auto s = numbers(&node, "scale", 3, document)) map = scaling({(*s)[0], (*s)[1], (*s)[2]});
  if (const auto q = numbers(&node, "rotation", 4, document)) {
    if (*q == std::vector<double>(4, 0.0))
      document.door.diagnostics.error(find(&node, "rotation")->where, "a rotation of length 0");
    map = map * Imath::Quatd((*q)[3], (*q)[0], (*q)[1], (*q)[2]).normalized().toMatrix44();
  }
  if (const auto t = numbers(&node, "translation", 3, document))
    map = map * translation({(*t)[0], (*t)[1], (*t)[2]});
  return map;
}

// Without its scale, which the format has no camera heed.
M44d unscaled(M44d map) {
  for (int row = 0; row < 3; ++row) {
    const V3d axis = V3d(map[row][0], map[row][1], map[row][2]).normalized();
    std::copy_n(axis.getValue(), 3, map[row]);
  }
  return map;
}

void set_view(const View& view, const Document& document) {
  constexpr double kHeight = 720;
  Door& door = document.door;
  const JsonValue& camera = *view.camera;
  GivenCamera given;
  given.where = camera.where;
  given.to_world = unscaled(scaling({1, 1, -1}) * view.map);  // it looks along -z
  if (!is_perspective(view))
    door.note(camera.where, "an orthographic camera has no counterpart here: perspective");
  const double aspect =
      std::clamp(number(&camera, "perspective/aspectRatio", 4.0 / 3, document), 0.01, 100.0);
  const double half_y = std::tan(number(&camera, "perspective/yfov", 0.8, document) / 2);
  given.fov_deg = 2 * std::atan(half_y * std::min(aspect, 1.0)) / kDegree;
  given.resolution = {static_cast<std::int64_t>(std::lround(kHeight * aspect)),
                      static_cast<std::int64_t>(kHeight)};
  set_camera(given, door);
}

// The first perspective camera, or, where none is, the first.
void choose_view(const std::vector<View>& views, const Document& document) {
  const auto perspective = std::ranges::find_if(views, is_perspective);
  const auto chosen = perspective == views.end() ? views.begin() : perspective;
  set_view(*chosen, document);
  for (auto view = views.begin(); view != views.end(); ++view)
    if (view != chosen)
      document.door.note(view->camera->where,
                         "a scene has one camera here: the first perspective one, if it has any");
}

// From far enough along z to see a ball around all meshes.
void set_default_view(const Document& document) {
  Door& door = document.door;
  const SourcePosition& where = document.root.where;
  door.note(where, "the file has no camera: one that sees all along -z");
  Imath::Box3d box;
  const auto read = load_mesh_file(document.file, FileMaterials::named, where, door.diagnostics,
                                   FileCoordinates::ignored, door.inputs);
  if (!read) return;
  for (const MeshFile::Submesh& part : read->submeshes)
    for (const V3d& vertex : part.mesh.vertices) box.extendBy(vertex);
  GivenCamera given;
  given.where = where;
  given.fov_deg = 40;
  given.resolution = {960, 720};
  const double distance = box.size().length() / 2 / std::sin(given.fov_deg * kDegree / 2);
  given.to_world = scaling({1, 1, -1}) * translation(box.center() + V3d(0, 0, distance));
  set_camera(given, door);
}

void add_light(const JsonValue& light, const M44d& map, const Document& document) {
  const std::string type = text(&light, "type", "");
  const LinearRgb rgb = colour(&light, "color", {1, 1, 1}, document);
  const double strength = number(&light, "intensity", 1, document) / kLuminousEfficacy;
  const LampSpectrum lamp = lamp_of(rgb, strength, light.where, document.door);
  const V3d at = V3d(0, 0, 0) * map;
  V3d along;
  map.multDirMatrix(V3d(0, 0, -1), along);
  if (find(&light, "range") != nullptr)
    document.door.note(light.where, "light goes on without end here: its range is dropped");
  if (type == "point") {
    add_lamp(
        spec::PointLamp{{at}, doors::emission_of<spec::PointEmission, Quantity::luminous_intensity>(lamp)},
        light.where, document.door);
  } else if (type == "spot") {
    const double inner = number(&light, "spot/innerConeAngle", 0, document) / kDegree;
    const double outer = number(&light, "spot/outerConeAngle", std::numbers::pi / 4, document) / kDegree;
    add_lamp(spec::SpotLamp{{at, along,
                             hard_cone(inner, outer, Falloff::squared_cosine, light.where, document.door)},
                            doors::emission_of<spec::PointEmission, Quantity::luminous_intensity>(lamp)},
             light.where, document.door);
  } else if (type == "directional") {
    spec::BeamLamp beam;
    beam.source.towards = -along;
    beam.emission = doors::emission_of<spec::BeamEmission, Quantity::illuminance>(lamp);
    add_lamp(beam, light.where, document.door);
  } else {
    document.door.diagnostics.error(
        light.where, unknown_name("light", type, std::vector<std::string>{"directional", "point", "spot"}));
  }
}

// Extensions that nothing here stands for; `of` names what has them.
void note_extensions(const JsonValue& object, std::string_view of, const Document& document) {
  const JsonValue* extensions = find(&object, "extensions");
  const auto* all = extensions ? std::get_if<JsonValue::Object>(&extensions->value) : nullptr;
  if (all == nullptr) return;
  for (const JsonValue::Member& member : *all)
    if (member.first != "KHR_lights_punctual")
      document.door.note(member.second.where,
                         fmt::format("{} of {} has no counterpart here: dropped", member.first, of));
}

// What a primitive holds beyond triangles.
void note_lost(const JsonValue& primitive, const Document& document) {
  Door& door = document.door;
  if (find(&primitive, "targets") != nullptr)
    door.note(primitive.where, "morph targets have no counterpart here: the mesh stands as it is stored");
  if (find(&primitive, "attributes/COLOR_0") != nullptr)
    door.note(primitive.where, "colours of vertices have no counterpart here: dropped");
  note_extensions(primitive, "a primitive", document);
}

void see_mesh(const JsonValue& mesh, Placed& placed, const Document& document) {
  for (const JsonValue& primitive : list(&mesh, "primitives")) {
    constexpr double kTriangles = 4;  // less are points and lines
    if (number(&primitive, "mode", kTriangles, document) < kTriangles) {
      document.door.note(primitive.where, "points and lines have no surface: dropped");
      continue;
    }
    note_lost(primitive, document);
    const JsonValue* material = find(&primitive, "material");
    if (material == nullptr)
      placed.materials.insert(std::nullopt);
    else if (element(document, "materials", material) != nullptr)
      placed.materials.insert(static_cast<std::size_t>(std::get<double>(material->value)));
  }
}

// Looks at every node of the scene, each at most once.
Placed walk(const Document& document) {
  Placed placed;
  struct Visit {
    const JsonValue* node;
    M44d parent;
  };
  std::vector<Visit> visits;
  std::set<const JsonValue*> seen;
  const auto push = [&](const JsonValue::Array& nodes, const M44d& parent) {
    for (auto index = nodes.rbegin(); index != nodes.rend(); ++index)
      if (const JsonValue* node = element(document, "nodes", &*index); node && seen.insert(node).second)
        visits.push_back({node, parent});
  };
  const JsonValue::Array& scenes = list(&document.root, "scenes");
  const JsonValue* chosen = find(&document.root, "scene");
  const JsonValue* scene = chosen           ? element(document, "scenes", chosen)
                           : scenes.empty() ? nullptr
                                            : &scenes.front();
  if (scene == nullptr) document.door.diagnostics.error(document.root.where, "it has no scene");
  note_extensions(document.root, "the file", document);
  if (!list(&document.root, "animations").empty())
    document.door.note(find(&document.root, "animations")->where,
                       "nothing moves during an exposure here: animations are dropped");
  push(list(scene, "nodes"), M44d());
  while (!visits.empty()) {
    const Visit visit = visits.back();
    visits.pop_back();
    const M44d map = local_map(*visit.node, document) * visit.parent;
    note_extensions(*visit.node, "a node", document);
    if (find(visit.node, "skin") != nullptr)
      document.door.note(visit.node->where,
                         "a skin has no counterpart here: the mesh stands as it is stored");
    if (const JsonValue* camera = element(document, "cameras", find(visit.node, "camera")))
      placed.views.push_back({camera, map});
    if (const JsonValue* light = element(document, "extensions/KHR_lights_punctual/lights",
                                         find(visit.node, "extensions/KHR_lights_punctual/light")))
      add_light(*light, map, document);
    if (const JsonValue* mesh = element(document, "meshes", find(visit.node, "mesh")))
      see_mesh(*mesh, placed, document);
    push(list(visit.node, "children"), map);
  }
  return placed;
}

// The triangles of one material, one shape.
void add_shape(std::optional<std::size_t> number, const std::string& name, const Document& document) {
  Door& door = document.door;
  const JsonValue* material = number ? &list(&document.root, "materials")[*number] : nullptr;
  const SourcePosition where = material ? material->where : document.root.where;
  spec::MeshBody body;
  body.surface.where = where;
  body.surface.value = spec::MeshPart{{{door.name_of(document.file)}, where}, {{name}, where}};
  body.material =
      spec::MaterialName{{door.add_material(name, material_of(material, where, document))}, where};
  if (material != nullptr) {
    if (const auto emission = emission_of(material, document)) {
      static_cast<spec::Emission&>(body.emission.emplace()) = *emission;
      const JsonValue* both = find(material, "doubleSided");
      body.two_sided = both && std::get_if<bool>(&both->value) && std::get<bool>(both->value);
    }
  }
  door.scene.shapes.push_back({name, std::move(body), where});
}

void read_scene(const Document& document) {
  Door& door = document.door;
  door.scene.sensor.emplace().counts = spec::StandardObserver{{{Observer::cie1931}, document.root.where}};
  const Placed placed = walk(document);
  if (!placed.views.empty()) choose_view(placed.views, document);
  const std::vector<std::string> names = names_of_materials(document);
  for (const auto& material : placed.materials)
    add_shape(material, names[material.value_or(names.size() - 1)], document);
  if (door.diagnostics.has_errors()) return;
  if (placed.views.empty()) set_default_view(document);
  const bool emits = std::ranges::any_of(door.scene.shapes, [](const spec::Shape& shape) {
    return std::get<spec::MeshBody>(shape.kind).emission.has_value();
  });
  if (door.scene.lights.empty() && !emits) door.note(document.root.where, "nothing shines in this scene");
}

}  // namespace
}  // namespace gltf

bool read_gltf_scene(const std::filesystem::path& file, Door& door) {
  gltf::Document document{door, file};
  if (gltf::read_document(document)) gltf::read_scene(document);
  return !door.diagnostics.has_errors();
}

}  // namespace abbe::doors

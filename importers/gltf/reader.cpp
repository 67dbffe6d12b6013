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

#include "description/meshes/mesh_file.h"
#include "importers/gltf/document.h"
#include "importers/shared/camera.h"
#include "importers/shared/placement.h"
#include "importers/shared/scene_importer.h"
#include "sampling/angle.h"
#include "spectral/colorimetry.h"

namespace abbe::importers {
namespace gltf {
namespace {

using Imath::M44d;
using Imath::V3d;
using spec::Quantity;

/// A camera and its transform to world coordinates.
struct View {
  const JsonValue* camera;
  M44d transform;
};

/// Materials and cameras that the nodes of the scene use.
struct SceneContents {
  std::set<std::optional<std::size_t>> materials{};
  std::vector<View> views{};
};

bool is_perspective(const View& view) {
  return text(view.camera, "type", "perspective") == "perspective";
}

// Local transform of a node: scale, rotation and translation, or a matrix, which the file stores column by
// column.
M44d local_transform(const JsonValue& node, const Document& document) {
  if (const auto m = numbers(&node, "matrix", 16, document)) return from_rows(*m).transposed();
  M44d transform;
  if (const auto s = numbers(&node, "scale", 3, document)) transform = scaling({(*s)[0], (*s)[1], (*s)[2]});
  if (const auto q = numbers(&node, "rotation", 4, document)) {
    if (*q == std::vector<double>(4, 0.0))
      document.importer.fail(find(&node, "rotation")->where, "a rotation quaternion must not be 0");
    transform = transform * Imath::Quatd((*q)[3], (*q)[0], (*q)[1], (*q)[2]).normalized().toMatrix44();
  }
  if (const auto t = numbers(&node, "translation", 3, document))
    transform = transform * translation({(*t)[0], (*t)[1], (*t)[2]});
  return transform;
}

// The transform without scale, which glTF ignores for cameras.
M44d unscaled(M44d transform) {
  for (int row = 0; row < 3; ++row) {
    const V3d axis = V3d(transform[row][0], transform[row][1], transform[row][2]).normalized();
    std::copy_n(axis.getValue(), 3, transform[row]);
  }
  return transform;
}

// Sets the camera with a picture of 720 rows. glTF gives the vertical field of view; Abbe takes the one along
// the shorter axis.
void set_view_camera(const View& view, const Document& document) {
  constexpr double kHeight = 720;
  SceneImporter& importer = document.importer;
  const JsonValue& camera = *view.camera;
  ImportedCamera imported;
  imported.where = camera.where;
  imported.to_world = unscaled(scaling({1, 1, -1}) * view.transform);  // glTF cameras look along -z.
  if (!is_perspective(view))
    importer.note(camera.where, "orthographic cameras are not supported: a perspective camera is used");
  const double aspect =
      std::clamp(number(&camera, "perspective/aspectRatio", 4.0 / 3, document), 0.01, 100.0);
  const double half_y = std::tan(number(&camera, "perspective/yfov", 0.8, document) / 2);
  imported.fov_deg = 2 * std::atan(half_y * std::min(aspect, 1.0)) / kDegree;
  imported.resolution = {static_cast<std::int64_t>(std::lround(kHeight * aspect)),
                         static_cast<std::int64_t>(kHeight)};
  set_camera(imported, importer);
}

void set_camera_from_views(const std::vector<View>& views, const Document& document) {
  const auto perspective = std::ranges::find_if(views, is_perspective);
  const auto chosen = perspective == views.end() ? views.begin() : perspective;
  set_view_camera(*chosen, document);
  for (auto view = views.begin(); view != views.end(); ++view)
    if (view != chosen)
      document.importer.note(view->camera->where,
                             "a scene has one camera: the first perspective camera, if any, is used");
}

// Sets a camera on the +z side, at a distance from which it sees a sphere around all meshes.
void set_default_view(const Document& document) {
  SceneImporter& importer = document.importer;
  const SourcePosition& where = document.root.where;
  importer.note(where, "the file has no camera: one that sees the whole scene along -z is used");
  Imath::Box3d box;
  const auto read = load_mesh_file(document.file, FileMaterials::named, where, importer.diagnostics,
                                   FileCoordinates::ignored, importer.inputs);
  if (!read) return;
  for (const MeshFile::Submesh& part : read->submeshes)
    for (const V3d& vertex : part.mesh.vertices) box.extendBy(vertex);
  ImportedCamera imported;
  imported.where = where;
  imported.fov_deg = 40;
  imported.resolution = {960, 720};
  const double distance = box.size().length() / 2 / std::sin(imported.fov_deg * kDegree / 2);
  imported.to_world = scaling({1, 1, -1}) * translation(box.center() + V3d(0, 0, distance));
  set_camera(imported, importer);
}

void add_light(const JsonValue& light, const M44d& transform, const Document& document) {
  const std::string type = text(&light, "type", "");
  const LinearRgb rgb = colour(&light, "color", {1, 1, 1}, document);
  const double strength = number(&light, "intensity", 1, document) / kLuminousEfficacy;
  const ImportedLightSpectrum emitted = light_spectrum_of(rgb, strength, light.where, document.importer);
  const V3d at = V3d(0, 0, 0) * transform;
  V3d along;
  transform.multDirMatrix(V3d(0, 0, -1), along);
  if (find(&light, "range") != nullptr)
    document.importer.note(light.where, "a range of lights is not supported: dropped");
  if (type == "point") {
    append_light<spec::PointLightSource, Quantity::luminous_intensity>({at}, emitted, light.where,
                                                                       document.importer);
  } else if (type == "spot") {
    const double inner = number(&light, "spot/innerConeAngle", 0, document) / kDegree;
    const double outer = number(&light, "spot/outerConeAngle", std::numbers::pi / 4, document) / kDegree;
    const double half_angle =
        hard_cone(inner, outer, Falloff::squared_cosine, light.where, document.importer);
    append_light<spec::SpotLightSource, Quantity::luminous_intensity>({at, along, half_angle}, emitted,
                                                                      light.where, document.importer);
  } else if (type == "directional") {
    append_light<spec::DirectionalLightSource, Quantity::illuminance>({-along, {}}, emitted, light.where,
                                                                      document.importer);
  } else {
    document.importer.is_known("light", type, {"directional", "point", "spot"}, light.where);
  }
}

// Notes unsupported extensions; `of` names the object in the note.
void note_extensions(const JsonValue& object, std::string_view of, const Document& document) {
  const JsonValue* extensions = find(&object, "extensions");
  const auto* all = extensions ? std::get_if<JsonValue::Object>(&extensions->value) : nullptr;
  if (all == nullptr) return;
  for (const JsonValue::Member& member : *all)
    if (member.first != "KHR_lights_punctual")
      document.importer.note(member.second.where,
                             fmt::format("{} of {} is not supported: dropped", member.first, of));
}

void note_unsupported_attributes(const JsonValue& primitive, const Document& document) {
  SceneImporter& importer = document.importer;
  if (find(&primitive, "targets") != nullptr)
    importer.note(primitive.where, "morph targets are not supported: the mesh is used as stored");
  if (find(&primitive, "attributes/COLOR_0") != nullptr)
    importer.note(primitive.where, "vertex colours are not supported: dropped");
  note_extensions(primitive, "a primitive", document);
}

void collect_mesh_materials(const JsonValue& mesh, SceneContents& contents, const Document& document) {
  for (const JsonValue& primitive : list(&mesh, "primitives")) {
    constexpr double kTriangles = 4;  // Smaller modes are points and lines.
    if (number(&primitive, "mode", kTriangles, document) < kTriangles) {
      document.importer.note(primitive.where, "points and lines have no surface: dropped");
      continue;
    }
    note_unsupported_attributes(primitive, document);
    const JsonValue* material = find(&primitive, "material");
    if (material == nullptr)
      contents.materials.insert(std::nullopt);
    else if (element(document, "materials", material) != nullptr)
      contents.materials.insert(static_cast<std::size_t>(std::get<double>(material->value)));
  }
}

// Visits every node of the scene, each at most once: adds lights, and collects cameras and materials.
SceneContents traverse_nodes(const Document& document) {
  SceneContents contents;
  struct Visit {
    const JsonValue* node;
    M44d parent;
  };
  std::vector<Visit> visits;
  std::set<const JsonValue*> visited;
  const auto push = [&](const JsonValue::Array& nodes, const M44d& parent) {
    for (auto index = nodes.rbegin(); index != nodes.rend(); ++index)
      if (const JsonValue* node = element(document, "nodes", &*index); node && visited.insert(node).second)
        visits.push_back({node, parent});
  };
  const JsonValue::Array& scenes = list(&document.root, "scenes");
  const JsonValue* chosen = find(&document.root, "scene");
  const JsonValue* scene = chosen           ? element(document, "scenes", chosen)
                           : scenes.empty() ? nullptr
                                            : &scenes.front();
  if (scene == nullptr) document.importer.fail(document.root.where, "the file has no scene");
  note_extensions(document.root, "the file", document);
  if (!list(&document.root, "animations").empty())
    document.importer.note(find(&document.root, "animations")->where,
                           "animations are not supported: dropped");
  push(list(scene, "nodes"), M44d());
  while (!visits.empty()) {
    const Visit visit = visits.back();
    visits.pop_back();
    const M44d transform = local_transform(*visit.node, document) * visit.parent;
    note_extensions(*visit.node, "a node", document);
    if (find(visit.node, "skin") != nullptr)
      document.importer.note(visit.node->where, "skins are not supported: the mesh is used as stored");
    if (const JsonValue* camera = element(document, "cameras", find(visit.node, "camera")))
      contents.views.push_back({camera, transform});
    if (const JsonValue* light = element(document, "extensions/KHR_lights_punctual/lights",
                                         find(visit.node, "extensions/KHR_lights_punctual/light")))
      add_light(*light, transform, document);
    if (const JsonValue* mesh = element(document, "meshes", find(visit.node, "mesh")))
      collect_mesh_materials(*mesh, contents, document);
    push(list(visit.node, "children"), transform);
  }
  return contents;
}

void add_shape(std::optional<std::size_t> number, const std::string& name, const Document& document) {
  SceneImporter& importer = document.importer;
  const JsonValue* material = number ? &list(&document.root, "materials")[*number] : nullptr;
  const SourcePosition where = material ? material->where : document.root.where;
  spec::MeshBody body;
  body.surface.where = where;
  body.surface.value = spec::MeshPart{{{importer.name_of(document.file)}, where}, {{name}, where}};
  body.material =
      spec::MaterialName{{importer.add_material(name, material_of(material, where, document))}, where};
  if (material != nullptr) {
    if (const auto emission = emission_of(material, document)) {
      static_cast<spec::Emission&>(body.emission.emplace()) = *emission;
      const JsonValue* both = find(material, "doubleSided");
      body.two_sided = both && std::get_if<bool>(&both->value) && std::get<bool>(both->value);
    }
  }
  importer.scene.shapes.push_back({name, std::move(body), where});
}

void read_scene(const Document& document) {
  SceneImporter& importer = document.importer;
  importer.scene.sensor.emplace().counts = spec::StandardObserver{{{Observer::cie1931}, document.root.where}};
  const SceneContents contents = traverse_nodes(document);
  if (!contents.views.empty()) set_camera_from_views(contents.views, document);
  const std::vector<std::string> names = material_names(document);
  for (const auto& material : contents.materials)
    add_shape(material, names[material.value_or(names.size() - 1)], document);
  if (importer.diagnostics.has_errors()) return;
  if (contents.views.empty()) set_default_view(document);
  const bool emits = std::ranges::any_of(importer.scene.shapes, [](const spec::Shape& shape) {
    return std::get<spec::MeshBody>(shape.kind).emission.has_value();
  });
  if (importer.scene.lights.empty() && !emits) importer.note(document.root.where, "the scene has no light");
}

}  // namespace
}  // namespace gltf

bool read_gltf_scene(const std::filesystem::path& file, SceneImporter& importer) {
  gltf::Document document{importer, file};
  if (gltf::read_document(document)) gltf::read_scene(document);
  return !importer.diagnostics.has_errors();
}

}  // namespace abbe::importers

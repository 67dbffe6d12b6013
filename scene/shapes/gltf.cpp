#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <ImathMatrix.h>
#include <ImathQuat.h>
#include <fmt/format.h>

#include "scene/shapes/gltf_buffers.h"
#include "scene/shapes/mesh_formats.h"

namespace abbe {
namespace {

/// What nodes have put together so far, by material.
using Parts = std::map<std::optional<std::size_t>, Mesh>;

enum Mode : std::size_t { triangle_list = 4, triangle_strip = 5, triangle_fan = 6 };

// How a primitive's vertices follow each other in triangles; nothing for points and lines.
std::vector<std::array<std::size_t, 3>> corners(std::size_t mode, std::size_t count) {
  std::vector<std::array<std::size_t, 3>> triangles;
  if (mode == triangle_list)
    for (std::size_t i = 0; i + 2 < count; i += 3) triangles.push_back({i, i + 1, i + 2});
  if (mode == triangle_strip)
    for (std::size_t i = 0; i + 2 < count; ++i) triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
  if (mode == triangle_fan)
    for (std::size_t i = 1; i + 1 < count; ++i) triangles.push_back({i, i + 1, 0});
  return triangles;
}

bool add_primitive(const Gltf& gltf, const JsonValue& primitive, const Imath::M44d& map, Parts& parts,
                   MeshReading& reading) {
  const JsonValue* attributes = primitive.find("attributes");
  const auto positions =
      Accessor::open(gltf, attributes ? natural(*attributes, "POSITION") : std::nullopt, "VEC3", reading);
  if (!positions) return false;
  if (!positions->is_float()) return reading.refuse("positions must be floats");
  std::optional<Accessor> indices;
  if (primitive.find("indices")) {
    indices = Accessor::open(gltf, natural(primitive, "indices"), "SCALAR", reading);
    if (!indices) return false;
    if (indices->is_float()) return reading.refuse("indices must be integers");
  }
  const std::optional<std::size_t> material =
      reading.materials == FileMaterials::wanted ? natural(primitive, "material") : std::nullopt;
  Mesh& mesh = parts[material];
  const std::size_t base = mesh.vertices.size();
  const auto triangles = corners(natural(primitive, "mode").value_or(triangle_list),
                                 indices ? indices->count() : positions->count());
  if (static_cast<double>(mesh.triangles.size() + triangles.size()) > kMaxTriangles ||
      static_cast<double>(base + positions->count()) > kMaxTriangles)
    return reading.refuse(fmt::format("too many triangles (allowed {})", kMaxTriangles));
  for (std::size_t i = 0; i < positions->count(); ++i)
    mesh.vertices.push_back(
        Imath::V3d(Imath::V3f(positions->real(i, 0), positions->real(i, 1), positions->real(i, 2))) * map);
  const bool mirror = map.determinant() < 0;
  for (std::array<std::size_t, 3> triangle : triangles) {
    for (std::size_t& corner : triangle) {
      if (indices) corner = indices->integer(corner);
      if (corner >= positions->count())
        return reading.refuse(
            fmt::format("an index names a vertex that does not exist (got {}, allowed [0, {}])", corner,
                        positions->count() - 1));
      corner += base;
    }
    if (mirror) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back({static_cast<std::uint32_t>(triangle[0]),
                              static_cast<std::uint32_t>(triangle[1]),
                              static_cast<std::uint32_t>(triangle[2])});
  }
  return true;
}

// For row vectors: scale, then rotation, then translation, or the matrix, whose columns the format lists.
Imath::M44d local_map(const JsonValue& node) {
  Imath::M44d map;
  if (const auto matrix = numbers(node, "matrix", 16)) {
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) map[i][j] = (*matrix)[static_cast<std::size_t>(4 * i + j)];
    return map;
  }
  if (const auto s = numbers(node, "scale", 3))
    map = Imath::M44d().setScale(Imath::V3d((*s)[0], (*s)[1], (*s)[2]));
  if (const auto q = numbers(node, "rotation", 4))
    map = map * Imath::Quatd((*q)[3], (*q)[0], (*q)[1], (*q)[2]).normalized().toMatrix44();
  if (const auto t = numbers(node, "translation", 3))
    map = map * Imath::M44d().setTranslation(Imath::V3d((*t)[0], (*t)[1], (*t)[2]));
  return map;
}

const JsonValue::Array& list(const JsonValue* parent, std::string_view key) {
  static const JsonValue::Array kEmpty;
  const JsonValue* json = parent ? parent->find(key) : nullptr;
  const auto* array = json ? std::get_if<JsonValue::Array>(&json->value) : nullptr;
  return array ? *array : kEmpty;
}

struct Visit {
  std::size_t node;
  Imath::M44d parent;
};
void push_nodes(const JsonValue::Array& nodes, const Imath::M44d& parent, std::vector<Visit>& visits) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    const auto* index = std::get_if<double>(&node->value);
    visits.push_back(
        {index && *index >= 0 && *index < 1e9 ? static_cast<std::size_t>(*index) : kNone, parent});
  }
}

// Every mesh the scene's nodes place. Nodes form a tree: one reached twice would let a small file grow
// without bound.
bool walk(const Gltf& gltf, Parts& parts, MeshReading& reading) {
  const JsonValue* scene = element(gltf, "scenes", natural(gltf.root, "scene").value_or(0));
  if (!scene) return reading.refuse("it has no scene");
  std::vector<bool> seen(list(&gltf.root, "nodes").size(), false);
  std::vector<Visit> visits;
  push_nodes(list(scene, "nodes"), Imath::M44d(), visits);
  while (!visits.empty()) {
    const Visit visit = visits.back();
    visits.pop_back();
    const JsonValue* node = element(gltf, "nodes", visit.node);
    if (!node || seen[visit.node])
      return reading.refuse(node ? fmt::format("node {} is reached twice", visit.node)
                                 : "a node does not exist");
    seen[visit.node] = true;
    const Imath::M44d map = local_map(*node) * visit.parent;
    if (node->find("mesh")) {
      const JsonValue* mesh = element(gltf, "meshes", natural(*node, "mesh"));
      if (!mesh) return reading.refuse("a mesh does not exist");
      for (const JsonValue& primitive : list(mesh, "primitives"))
        if (!add_primitive(gltf, primitive, map, parts, reading)) return false;
    }
    push_nodes(list(node, "children"), map, visits);
  }
  return true;
}

bool in_unit(double x) {
  return x >= 0 && x <= 1;
}

// What the file says beyond a colour or an index goes into `lost`, in its own words.
void note(FileMaterial& material, const char* what, double value, double neutral) {
  if (value != neutral) material.lost.push_back(fmt::format("{} {:g}", what, value));
}
void note_textures(FileMaterial& material, const JsonValue* json) {
  constexpr std::array<std::pair<const char*, const char*>, 5> kTextures{
      {{"baseColorTexture", "base colour texture"},
       {"metallicRoughnessTexture", "metallic-roughness texture"},
       {"normalTexture", "normal texture"},
       {"occlusionTexture", "occlusion texture"},
       {"emissiveTexture", "emissive texture"}}};
  for (const auto& [key, words] : kTextures)
    if (json && json->find(key)) material.lost.emplace_back(words);
}
void note_extensions(FileMaterial& material, const JsonValue* extensions, bool clear) {
  const auto* members = extensions ? std::get_if<JsonValue::Object>(&extensions->value) : nullptr;
  if (!members) return;
  for (const auto& [name, value] : *members)
    if (!clear || (name != "KHR_materials_transmission" && name != "KHR_materials_ior"))
      material.lost.push_back(name);
}

bool read_material(const JsonValue& json, std::size_t number, MeshReading& reading) {
  FileMaterial material;
  const JsonValue* name = json.find("name");
  const auto* text = name ? std::get_if<std::string>(&name->value) : nullptr;
  material.name = text ? *text : fmt::format("material {}", number);
  const JsonValue none{};
  const JsonValue* pbr = json.find("pbrMetallicRoughness");
  const JsonValue& surface = pbr ? *pbr : none;
  const std::vector<double> color =
      numbers(surface, "baseColorFactor", 4).value_or(std::vector{1.0, 1.0, 1.0, 1.0});
  if (!std::all_of(color.begin(), color.end(), in_unit))
    return reading.refuse(fmt::format("material \"{}\": baseColorFactor (got [{}], allowed [0, 1])",
                                      material.name, fmt::join(color, ", ")));
  material.color = {color[0], color[1], color[2]};
  const JsonValue* extensions = json.find("extensions");
  const JsonValue* transmission = extensions ? extensions->find("KHR_materials_transmission") : nullptr;
  const double transmitted = transmission ? number_or(*transmission, "transmissionFactor", 0) : 0;
  const bool clear = transmitted > 0;
  if (clear) {
    constexpr double kDefaultIndex = 1.5;
    const JsonValue* ior = extensions->find("KHR_materials_ior");
    material.index = ior ? number_or(*ior, "ior", kDefaultIndex) : kDefaultIndex;
    if (!(*material.index > 0 && *material.index <= 100))
      return reading.refuse(
          fmt::format("material \"{}\": ior (got {}, allowed (0, 100])", material.name, *material.index));
    note(material, "transmission", transmitted, 1);
    if (transmission->find("transmissionTexture")) material.lost.emplace_back("transmission texture");
    if (material.color != LinearRgb{1, 1, 1}) material.lost.emplace_back("base colour");
  }
  note(material, "metallic", number_or(surface, "metallicFactor", 1), 0);
  note(material, "roughness", number_or(surface, "roughnessFactor", 1), clear ? 0 : 1);
  note_textures(material, pbr);
  note_textures(material, &json);
  if (const auto emissive = numbers(json, "emissiveFactor", 3);
      emissive && *emissive != std::vector{0.0, 0.0, 0.0})
    material.lost.emplace_back("emission");
  if (const JsonValue* alpha = json.find("alphaMode"))
    if (const auto* mode = std::get_if<std::string>(&alpha->value); mode && *mode != "OPAQUE")
      material.lost.push_back("alpha mode " + *mode);
  note_extensions(material, extensions, clear);
  reading.file.materials.push_back(std::move(material));
  return true;
}

}  // namespace

bool read_gltf(std::string&& bytes, MeshReading& reading) {
  Gltf gltf;
  if (!open_gltf(std::move(bytes), gltf, reading)) return false;
  for (const JsonValue& name : list(&gltf.root, "extensionsRequired")) {
    const auto* extension = std::get_if<std::string>(&name.value);
    if (!extension || !extension->starts_with("KHR_materials_"))
      return reading.refuse(
          fmt::format("it requires the extension {}, which is not read", extension ? *extension : "?"));
  }
  Parts parts;
  if (!walk(gltf, parts, reading)) return false;
  if (reading.materials == FileMaterials::wanted) {
    const JsonValue::Array& materials = list(&gltf.root, "materials");
    for (std::size_t i = 0; i < materials.size(); ++i)
      if (!read_material(materials[i], i, reading)) return false;
    if (parts.contains(std::nullopt)) {  // what the format says then
      reading.file.materials.push_back({"default", {1, 1, 1}, std::nullopt, {"metallic 1"}});
    }
  }
  for (auto& [material, mesh] : parts) {
    if (mesh.triangles.empty()) continue;  // points and lines
    const std::size_t last = reading.file.materials.size();
    const bool wanted = reading.materials == FileMaterials::wanted;
    if (wanted && material && *material >= last) return reading.refuse("a material does not exist");
    reading.file.parts.push_back(
        {std::move(mesh), wanted ? std::optional(material.value_or(last - 1)) : std::nullopt});
  }
  return true;
}

}  // namespace abbe

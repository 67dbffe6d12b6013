#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <ImathMatrix.h>
#include <ImathQuat.h>
#include <fmt/format.h>
#include <tiny_gltf.h>

#include "description/meshes/gltf_file.h"
#include "description/meshes/mesh_formats.h"
#include "io/json.h"
#include "io/text.h"
#include "scene/shapes/shape.h"

namespace abbe {
namespace {

const tinygltf::Value* extension(const tinygltf::Material& from, const char* name) {
  const auto found = from.extensions.find(name);
  return found == from.extensions.end() ? nullptr : &found->second;
}
double number_or(const tinygltf::Value* object, const char* key, double otherwise) {
  return object && object->Has(key) && object->Get(key).IsNumber() ? object->Get(key).GetNumberAsDouble()
                                                                   : otherwise;
}

// Adds a feature that Abbe does not represent to `ignored`, in the words of the format.
void note(FileMaterial& material, const char* what, double value, double neutral) {
  if (value != neutral) material.ignored.push_back(fmt::format("{} {:g}", what, value));
}
void note_textures(FileMaterial& material, const tinygltf::Material& from) {
  const std::pair<int, const char*> textures[] = {
      {from.pbrMetallicRoughness.baseColorTexture.index, "base colour texture"},
      {from.pbrMetallicRoughness.metallicRoughnessTexture.index, "metallic-roughness texture"},
      {from.normalTexture.index, "normal texture"},
      {from.occlusionTexture.index, "occlusion texture"},
      {from.emissiveTexture.index, "emissive texture"}};
  for (const auto& [index, words] : textures)
    if (index != -1) material.ignored.emplace_back(words);
}

// Reads the refractive index of a transmitting material, which becomes clear glass, and notes the features
// that are ignored then.
void read_transmission(const tinygltf::Material& from, FileMaterial& material) {
  constexpr double kDefaultIndex = 1.5;
  const tinygltf::Value* transmission = extension(from, "KHR_materials_transmission");
  const double transmitted = number_or(transmission, "transmissionFactor", 0);
  if (!(transmitted > 0)) return;
  material.index = number_or(extension(from, "KHR_materials_ior"), "ior", kDefaultIndex);
  if (!(*material.index > 0 && *material.index <= 100))
    throw MeshFault{
        fmt::format("material \"{}\": ior (got {}, allowed (0, 100])", material.name, *material.index)};
  note(material, "transmission", transmitted, 1);
  if (transmission->Has("transmissionTexture")) material.ignored.emplace_back("transmission texture");
  if (material.color != LinearRgb{1, 1, 1}) material.ignored.emplace_back("base colour");
}

// Adds a material to `reading.file.materials`. Its index `number` in the file, counted from 0, names it if it
// has no name. Refuses a base colour outside [0, 1], and a refractive index outside (0, 100].
void read_gltf_material(const tinygltf::Material& from, std::size_t number, MeshReading& reading) {
  FileMaterial material;
  material.name = from.name.empty() ? unnamed_gltf_material(number) : from.name;
  const tinygltf::PbrMetallicRoughness& surface = from.pbrMetallicRoughness;
  const std::vector<double>& color = surface.baseColorFactor;
  if (!std::all_of(color.begin(), color.end(), [](double x) { return x >= 0 && x <= 1; }))
    throw MeshFault{fmt::format("material \"{}\": baseColorFactor (got [{}], allowed [0, 1])", material.name,
                                fmt::join(color, ", "))};
  material.color = {color.at(0), color.at(1), color.at(2)};
  read_transmission(from, material);
  const bool clear = material.index.has_value();
  note(material, "metallic", surface.metallicFactor, 0);
  note(material, "roughness", surface.roughnessFactor, clear ? 0 : 1);
  note_textures(material, from);
  if (from.emissiveFactor != std::vector{0.0, 0.0, 0.0}) material.ignored.emplace_back("emission");
  if (from.alphaMode != "OPAQUE") material.ignored.push_back("alpha mode " + from.alphaMode);
  for (const auto& [name, value] : from.extensions)
    if (!clear || (name != "KHR_materials_transmission" && name != "KHR_materials_ior"))
      material.ignored.push_back(name);
  reading.file.materials.push_back(std::move(material));
}

// Refuses a file that violates the assumptions of the library. These are:
// - JSON nested so little that recursion ends;
// - JSON whose length fits an int;
// - at most one buffer without a uri, because each gets a copy of the binary data.
void require_well_formed(std::string_view bytes, MeshReading& reading) {
  const auto json = gltf_json(bytes);
  if (!json) throw MeshFault{kBadGlb};
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max() ||
      json->size() > std::numeric_limits<std::int32_t>::max())
    throw MeshFault{"file too large"};
  if (valid_prefix(*json) != json->size()) throw MeshFault{"its JSON is not UTF-8 text"};
  Diagnostics diagnostics;
  const auto root =
      parse_json(std::make_shared<const SourceText>(SourceText{reading.path.string(), std::string(*json)}),
                 diagnostics, &reading.memory);
  if (!root) throw MeshFault{"malformed JSON: " + diagnostics.all()[0].message};
  const JsonValue* list = root->find("buffers");
  const auto* buffers = list ? std::get_if<JsonValue::Array>(&list->value) : nullptr;
  if (buffers && std::count_if(buffers->begin(), buffers->end(),
                               [](const JsonValue& buffer) { return !buffer.find("uri"); }) > 1)
    throw MeshFault{"more than one buffer has no uri"};
}

/// State of the library's callbacks. The library opens names as they are, because it is given no folder.
struct Files {
  MeshReading& reading;
  const tinygltf::Model& model;
};
// Buffers are read before anything else and images after the views. So a file is needed only while there are
// no views.
bool file_wanted(const std::string& /*name*/, void* user) {
  return static_cast<Files*>(user)->model.bufferViews.empty();
}
std::string same_name(const std::string& name, void* /*user*/) {
  return name;
}
bool read_file(std::vector<unsigned char>* to, std::string* /*error*/, const std::string& name, void* user) {
  std::string bytes;
  read_named_bytes(name, bytes, static_cast<Files*>(user)->reading);
  to->assign(bytes.begin(), bytes.end());
  return true;
}
bool ignore_image(tinygltf::Image* /*image*/, int /*number*/, std::string* /*error*/,
                  std::string* /*warning*/, int /*width*/, int /*height*/, const unsigned char* /*bytes*/,
                  int /*size*/, void* /*user*/) {
  return true;
}

// True if a file has the same meshes with and without this extension.
bool preserves_meshes(const std::string& extension) {
  return extension.starts_with("KHR_materials_") || extension == "KHR_lights_punctual" ||
         extension == "KHR_texture_transform";
}

void load(const std::string& bytes, tinygltf::Model& model, MeshReading& reading) {
  require_well_formed(bytes, reading);
  Files files{reading, model};
  tinygltf::TinyGLTF library;
  library.SetFsCallbacks({file_wanted, same_name, read_file, nullptr, &files});
  library.SetImageLoader(ignore_image, nullptr);
  const auto size = static_cast<unsigned>(bytes.size());
  std::string error;
  std::string warning;
  try {
    if (bytes.starts_with("glTF"))
      library.LoadBinaryFromMemory(&model, &error, &warning,
                                   reinterpret_cast<const unsigned char*>(bytes.data()), size);
    else
      library.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, "");
  } catch (const Error&) {  // Thrown if memory is exhausted.
    throw;
  } catch (const std::exception& fault) {  // Thrown for malformed JSON or an empty buffer.
    if (dynamic_cast<const std::bad_alloc*>(&fault)) throw;
    error += fault.what();
  }
  // The library continues after some errors. All of them lose data, except this one, which the format allows.
  constexpr std::string_view kAllowed = "'inverseBindMatrices' property is missing in Skin.\n";
  for (std::size_t at = 0; (at = error.find(kAllowed)) != std::string::npos;)
    error.erase(at, kAllowed.size());
  constexpr std::size_t kLine = 200;  // A message may repeat a whole buffer.
  error = error.substr(0, std::min(error.find('\n'), kLine));
  if (!error.empty()) throw MeshFault{error.substr(0, valid_prefix(error))};
  if (!model.asset.version.starts_with("2.")) throw MeshFault{"not a glTF 2.0 asset"};
  for (const std::string& extension : model.extensionsRequired)
    if (!preserves_meshes(extension))
      throw MeshFault{fmt::format("it requires the extension {}, which is not supported", extension)};
}

/// A strided view of elements in a buffer of a tinygltf::Model, which must outlive it. `numbers_of` ensures
/// that all elements lie within the buffer, which the library does not check.
struct GltfNumbers {
  const unsigned char* first;  ///< First byte of the first element; need not be aligned.
  std::size_t count;           ///< Number of elements, at least 1.
  std::size_t stride;          ///< Distance between elements [bytes].
  int component_type;          ///< A TINYGLTF_COMPONENT_TYPE.

  template <typename T>
  [[nodiscard]] T at(std::size_t i, std::size_t component = 0) const {
    T value;
    std::memcpy(&value, first + i * stride + component * sizeof value, sizeof value);
    return value;
  }
  [[nodiscard]] std::uint32_t index_at(std::size_t i) const {
    if (component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return at<std::uint8_t>(i);
    if (component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return at<std::uint16_t>(i);
    return at<std::uint32_t>(i);
  }
  [[nodiscard]] Imath::V3d vector_at(std::size_t i) const {
    return Imath::V3d(Imath::V3f(at<float>(i, 0), at<float>(i, 1), at<float>(i, 2)));
  }
  // Bytes and shorts are fractions of their maximum.
  [[nodiscard]] float fraction_at(std::size_t i, std::size_t component) const {
    if (component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE)
      return static_cast<float>(at<std::uint8_t>(i, component)) / 255;
    if (component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
      return static_cast<float>(at<std::uint16_t>(i, component)) / 65535;
    return at<float>(i, component);
  }
};

/// Element of a list that the file refers to by its index, counted from 0; nullptr if it is out of range.
template <typename T>
const T* at(const std::vector<T>& list, int index) {
  return index >= 0 && static_cast<std::size_t>(index) < list.size() ? &list[static_cast<std::size_t>(index)]
                                                                     : nullptr;
}

/// Form of the elements of an accessor.
struct GltfForm {
  int type;                          ///< TINYGLTF_TYPE_SCALAR, VEC2 or VEC3.
  std::vector<int> component_types;  ///< Those allowed.
  const char* fault;                 ///< Error message for other components.
};

/// The elements of an accessor. Refuses one that does not exist, has another form, is sparse or empty, or
/// exceeds its buffer.
GltfNumbers numbers_of(const tinygltf::Model& model, int index, const GltfForm& form) {
  const auto refuse = [&](const std::string& what) {
    throw MeshFault{fmt::format("accessor {}: {}", index, what)};
  };
  const auto* accessor = at(model.accessors, index);
  if (!accessor) refuse("it does not exist");
  if (accessor->sparse.isSparse) refuse("sparse accessors are not supported");
  if (accessor->type != form.type)
    refuse(fmt::format("wrong type (allowed {})", form.type == TINYGLTF_TYPE_VEC3   ? "VEC3"
                                                  : form.type == TINYGLTF_TYPE_VEC2 ? "VEC2"
                                                                                    : "SCALAR"));
  const auto* view = at(model.bufferViews, accessor->bufferView);
  const auto* buffer = view ? at(model.buffers, view->buffer) : nullptr;
  if (!buffer || view->byteOffset > buffer->data.size() ||
      view->byteLength > buffer->data.size() - view->byteOffset)
    refuse("its view exceeds the buffer or does not exist");
  const int stride = accessor->ByteStride(*view);
  const int width = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor->componentType)) *
                    tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(form.type));
  if (width <= 0) refuse("unknown component type");
  if (accessor->count == 0) refuse("it is empty");
  const std::size_t room = view->byteLength;
  const GltfNumbers numbers{buffer->data.data() + view->byteOffset + std::min(accessor->byteOffset, room),
                            accessor->count, static_cast<std::size_t>(std::max(stride, 0)),
                            accessor->componentType};
  if (stride < width || accessor->byteOffset > room ||
      static_cast<std::size_t>(width) > room - accessor->byteOffset ||
      numbers.count - 1 > (room - accessor->byteOffset - static_cast<std::size_t>(width)) / numbers.stride)
    refuse("it needs more bytes than the buffer holds");
  if (std::ranges::find(form.component_types, numbers.component_type) == form.component_types.end())
    throw MeshFault{form.fault};
  return numbers;
}

// Index of the accessor of an attribute, if the primitive has it.
std::optional<int> attribute(const tinygltf::Primitive& primitive, const char* name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? std::nullopt : std::optional(found->second);
}

// Largest number of triangles, and of vertices, of one material. It is counted after nodes are expanded: a
// small file can repeat a mesh many times.
constexpr double kMaxTriangles = 67108864;

/// The meshes of all nodes so far, by material.
using MeshesByMaterial = std::map<std::optional<std::size_t>, Mesh>;

/// The texture coordinates of the vertices of a primitive; none if it has none or they are not requested. v
/// increases downwards in glTF and upwards in the result.
std::vector<Imath::V2f> coordinates_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                       std::size_t vertices, const MeshReading& reading) {
  std::vector<Imath::V2f> coordinates;
  const auto named = attribute(primitive, "TEXCOORD_0");
  if (reading.coordinates == FileCoordinates::ignored || !named) return coordinates;
  const GltfNumbers numbers =
      numbers_of(model, *named,
                 {TINYGLTF_TYPE_VEC2,
                  {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                   TINYGLTF_COMPONENT_TYPE_FLOAT},
                  "texture coordinates must be floats, bytes or shorts"});
  for (std::size_t i = 0; i < numbers.count; ++i) {
    coordinates.emplace_back(numbers.fraction_at(i, 0), 1 - numbers.fraction_at(i, 1));
    if (!std::isfinite(coordinates.back().x) || !std::isfinite(coordinates.back().y))
      throw MeshFault{fmt::format("texture coordinates of vertex {} are not finite", i)};
  }
  if (numbers.count != vertices) throw MeshFault{"as many texture coordinates as positions are needed"};
  return coordinates;
}

/// The normals of the vertices of a primitive, transformed like the vertices; none if it has none.
std::vector<Imath::V3f> normals_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                   std::size_t vertices, const Imath::M44d& map) {
  std::vector<Imath::V3f> normals;
  const auto named = attribute(primitive, "NORMAL");
  if (!named) return normals;
  const GltfNumbers numbers = numbers_of(
      model, *named, {TINYGLTF_TYPE_VEC3, {TINYGLTF_COMPONENT_TYPE_FLOAT}, "normals must be floats"});
  const Placement at = placement(map);
  for (std::size_t i = 0; i < numbers.count; ++i)
    normals.push_back(unit_normal(normal_to_world(at, numbers.vector_at(i))));
  if (numbers.count != vertices)
    throw MeshFault{
        fmt::format("as many normals as positions are needed (got {}, allowed {})", numbers.count, vertices)};
  return normals;
}

// Indices of the vertices of each triangle of a primitive; empty for points and lines.
std::vector<std::array<std::size_t, 3>> corners(int mode, std::size_t count) {
  std::vector<std::array<std::size_t, 3>> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES)
    for (std::size_t i = 0; i + 2 < count; i += 3) triangles.push_back({i, i + 1, i + 2});
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
    for (std::size_t i = 0; i + 2 < count; ++i) triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
    for (std::size_t i = 1; i + 1 < count; ++i) triangles.push_back({i, i + 1, 0});
  return triangles;
}

// Adds the normals at the corners of the next triangle of the mesh. Earlier triangles without normals get
// zero.
void add_normals(const std::array<std::size_t, 3>& triangle, std::size_t base,
                 const std::vector<Imath::V3f>& normals, Mesh& mesh) {
  mesh.normals.resize(mesh.triangles.size());
  auto& corners = mesh.normals.emplace_back();
  for (std::size_t i = 0; i < 3; ++i) {
    corners.at(i) = normals[triangle.at(i) - base];
    if (corners.at(i) == Imath::V3f(0))
      throw MeshFault{fmt::format("the normal of vertex {} has no direction", triangle.at(i) - base)};
  }
}

// Adds the triangles of a primitive, transformed by `map`, to the mesh of its material.
void add_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const Imath::M44d& map,
                   MeshesByMaterial& meshes, MeshReading& reading) {
  const GltfNumbers positions =
      numbers_of(model, attribute(primitive, "POSITION").value_or(-1),
                 {TINYGLTF_TYPE_VEC3, {TINYGLTF_COMPONENT_TYPE_FLOAT}, "positions must be floats"});
  std::optional<GltfNumbers> indices;
  if (primitive.indices >= 0)
    indices = numbers_of(model, primitive.indices,
                         {TINYGLTF_TYPE_SCALAR,
                          {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                           TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT},
                          "indices must be integers >= 0"});
  std::optional<std::size_t> material;
  if (reading.materials != FileMaterials::ignored && primitive.material >= 0)
    material = static_cast<std::size_t>(primitive.material);
  Mesh& mesh = meshes[material];
  const std::size_t base = mesh.vertices.size();
  const auto triangles = corners(primitive.mode, indices ? indices->count : positions.count);
  if (static_cast<double>(mesh.triangles.size() + triangles.size()) > kMaxTriangles ||
      static_cast<double>(base + positions.count) > kMaxTriangles)
    throw MeshFault{fmt::format("too many triangles (allowed {})", kMaxTriangles)};
  reading.make_room(mesh.vertices, positions.count);
  reading.make_room(mesh.triangles, triangles.size());
  for (std::size_t i = 0; i < positions.count; ++i) mesh.vertices.push_back(positions.vector_at(i) * map);
  const auto coordinates = coordinates_of(model, primitive, positions.count, reading);
  const auto normals = normals_of(model, primitive, positions.count, map);
  if (!coordinates.empty()) reading.make_room(mesh.coordinates, triangles.size());
  if (!normals.empty())
    reading.make_room(mesh.normals, mesh.triangles.size() - mesh.normals.size() + triangles.size());
  const bool mirror = map.determinant() < 0;
  for (std::array<std::size_t, 3> triangle : triangles) {
    for (std::size_t& corner : triangle) {
      if (indices) corner = indices->index_at(corner);
      if (corner >= positions.count)
        throw MeshFault{fmt::format("an index names a vertex that does not exist (got {}, allowed [0, {}])",
                                    corner, positions.count - 1)};
      corner += base;
    }
    if (mirror) std::swap(triangle[1], triangle[2]);
    if (!coordinates.empty())
      mesh.coordinates.push_back({coordinates[triangle[0] - base], coordinates[triangle[1] - base],
                                  coordinates[triangle[2] - base]});
    if (!normals.empty()) add_normals(triangle, base, normals, mesh);
    mesh.triangles.push_back({static_cast<std::uint32_t>(triangle[0]),
                              static_cast<std::uint32_t>(triangle[1]),
                              static_cast<std::uint32_t>(triangle[2])});
  }
}

// Transform of a node for row vectors: scale, then rotation, then translation; or the matrix, which the
// format lists by columns.
Imath::M44d local_map(const tinygltf::Node& node) {
  Imath::M44d map;
  if (node.matrix.size() == 16) {
    std::copy(node.matrix.begin(), node.matrix.end(), map.getValue());
    return map;
  }
  const std::vector<double>& s = node.scale;
  const std::vector<double>& q = node.rotation;
  const std::vector<double>& t = node.translation;
  if (s.size() == 3) map = Imath::M44d().setScale(Imath::V3d(s[0], s[1], s[2]));
  if (q.size() == 4) map = map * Imath::Quatd(q[3], q[0], q[1], q[2]).normalized().toMatrix44();
  if (t.size() == 3) map = map * Imath::M44d().setTranslation(Imath::V3d(t[0], t[1], t[2]));
  return map;
}

// Adds every mesh of the nodes of the scene. Nodes form a tree; a node that is reached twice is an error,
// because a small file could otherwise grow without bound.
void add_scene_meshes(const tinygltf::Model& model, MeshesByMaterial& meshes, MeshReading& reading) {
  const auto* scene = at(model.scenes, std::max(model.defaultScene, 0));
  if (!scene) throw MeshFault{"it has no scene"};
  struct Visit {
    int node;
    Imath::M44d parent;
  };
  std::vector<Visit> visits;
  const auto push = [&](const std::vector<int>& nodes, const Imath::M44d& parent) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) visits.push_back({*node, parent});
  };
  std::vector<bool> visited(model.nodes.size(), false);
  push(scene->nodes, Imath::M44d());
  while (!visits.empty()) {
    const Visit visit = visits.back();
    visits.pop_back();
    const auto* node = at(model.nodes, visit.node);
    if (!node) throw MeshFault{"a node does not exist"};
    if (visited[static_cast<std::size_t>(visit.node)])
      throw MeshFault{fmt::format("node {} is reached twice", visit.node)};
    visited[static_cast<std::size_t>(visit.node)] = true;
    if (node->rotation == std::vector<double>(4, 0.0))
      throw MeshFault{fmt::format("node {}: a rotation of length 0", visit.node)};
    const Imath::M44d map = local_map(*node) * visit.parent;
    if (node->mesh != -1) {
      const auto* mesh = at(model.meshes, node->mesh);
      if (!mesh) throw MeshFault{"a mesh does not exist"};
      for (const tinygltf::Primitive& primitive : mesh->primitives)
        add_primitive(model, primitive, map, meshes, reading);
    }
    push(node->children, map);
  }
}

}  // namespace

void read_gltf(std::string&& bytes, MeshReading& reading) {
  tinygltf::Model model;
  load(bytes, model, reading);
  bytes = {};
  for (const auto& [count, what] :
       {std::pair(model.lights.size(), "lights"), {model.cameras.size(), "cameras"}})
    if (count > 0) reading.ignored.push_back(fmt::format("its {} are not read ({} of them)", what, count));
  MeshesByMaterial meshes;
  add_scene_meshes(model, meshes, reading);
  if (reading.materials != FileMaterials::ignored) {
    for (std::size_t i = 0; i < model.materials.size(); ++i)
      read_gltf_material(model.materials[i], i, reading);
    if (meshes.contains(std::nullopt)) {  // The default material of the format.
      reading.file.materials.push_back({kDefaultGltfMaterial, {1, 1, 1}, std::nullopt, {"metallic 1"}});
    }
  }
  std::vector<std::string> names;
  for (const FileMaterial& material : reading.file.materials) names.push_back(material.name);
  names = distinct_names(std::move(names));
  for (std::size_t i = 0; i < names.size(); ++i) reading.file.materials[i].name = std::move(names[i]);
  for (auto& [material, mesh] : meshes) {
    if (mesh.triangles.empty()) continue;  // Only points and lines.
    if (mesh.coordinates.size() < mesh.triangles.size()) mesh.coordinates.clear();
    if (!mesh.normals.empty()) mesh.normals.resize(mesh.triangles.size());
    const std::size_t last = reading.file.materials.size();
    const bool wanted = reading.materials != FileMaterials::ignored;
    if (wanted && material && *material >= last) throw MeshFault{"a material does not exist"};
    reading.file.submeshes.push_back(
        {std::move(mesh), wanted ? std::optional(material.value_or(last - 1)) : std::nullopt});
  }
}

}  // namespace abbe

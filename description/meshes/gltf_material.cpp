#include "description/meshes/gltf_material.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "description/meshes/gltf_names.h"

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
bool read_transmission(const tinygltf::Material& from, FileMaterial& material, MeshReading& reading) {
  constexpr double kDefaultIndex = 1.5;
  const tinygltf::Value* transmission = extension(from, "KHR_materials_transmission");
  const double transmitted = number_or(transmission, "transmissionFactor", 0);
  if (!(transmitted > 0)) return true;
  material.index = number_or(extension(from, "KHR_materials_ior"), "ior", kDefaultIndex);
  if (!(*material.index > 0 && *material.index <= 100))
    return reading.refuse(
        fmt::format("material \"{}\": ior (got {}, allowed (0, 100])", material.name, *material.index));
  note(material, "transmission", transmitted, 1);
  if (transmission->Has("transmissionTexture")) material.ignored.emplace_back("transmission texture");
  if (material.color != LinearRgb{1, 1, 1}) material.ignored.emplace_back("base colour");
  return true;
}

}  // namespace

bool read_gltf_material(const tinygltf::Material& from, std::size_t number, MeshReading& reading) {
  FileMaterial material;
  material.name = from.name.empty() ? unnamed_gltf_material(number) : from.name;
  const tinygltf::PbrMetallicRoughness& surface = from.pbrMetallicRoughness;
  const std::vector<double>& color = surface.baseColorFactor;
  if (!std::all_of(color.begin(), color.end(), [](double x) { return x >= 0 && x <= 1; }))
    return reading.refuse(fmt::format("material \"{}\": baseColorFactor (got [{}], allowed [0, 1])",
                                      material.name, fmt::join(color, ", ")));
  material.color = {color.at(0), color.at(1), color.at(2)};
  if (!read_transmission(from, material, reading)) return false;
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
  return true;
}

}  // namespace abbe

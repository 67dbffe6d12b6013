#include "description/load_material.h"

#include "description/material.h"
#include "description/scene.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/schema/read.h"
#include "io/text.h"

namespace abbe {
namespace {

struct MaterialPath {
  std::filesystem::path path;
  std::string name;  // Empty if not given.
};

// Splits "FILE" or "FILE:NAME".
MaterialPath split_name(const std::string& words) {
  const std::size_t colon = words.rfind(".json:");
  if (colon == std::string::npos) return {words, ""};
  const std::size_t end = colon + std::string_view(".json").size();
  return {words.substr(0, end), words.substr(end + 1)};
}

// The materials of a scene file, or the single material that the whole text describes.
JsonValue materials_of(JsonValue root) {
  if (const JsonValue* materials = root.find("materials")) return *materials;
  JsonValue all{JsonValue::Object{}, root.where};
  std::get<JsonValue::Object>(all.value).push_back({"material", std::move(root)});
  return all;
}

const Material* chosen(const std::vector<Material>& materials, const std::string& name,
                       const SourcePosition& where, Diagnostics& diagnostics) {
  if (name.empty() && materials.size() == 1) return &materials.front();
  std::vector<std::string> names;
  for (const Material& material : materials) {
    if (material.name == name) return &material;
    names.push_back(material.name);
  }
  diagnostics.error(
      where, name.empty() ? fmt::format("several materials: add :NAME, one of {}", fmt::join(names, ", "))
                          : unknown_name("material", name, names));
  return nullptr;
}

}  // namespace

std::optional<Material> load_material(const std::string& words, Diagnostics& diagnostics, Inputs* inputs) {
  const bool in_place = words.starts_with('{');
  const MaterialPath material_path = in_place ? MaterialPath{} : split_name(words);
  const auto source = in_place ? std::make_shared<const SourceText>(SourceText{"MATERIAL", words})
                               : read_text(material_path.path, diagnostics);
  if (!source) return std::nullopt;
  std::optional<JsonValue> root = parse_json(source, diagnostics);
  if (!root) return std::nullopt;
  spec::Unit unit{};
  if (const JsonValue* units = root->find("units"))
    (void)schema::read(*units, spec::units(), &unit, diagnostics);
  const JsonValue materials = materials_of(*std::move(root));
  if (inputs && !in_place) inputs->add_file(material_path.path);
  description::LoadContext context{diagnostics, material_path.path.parent_path(), inputs, spec::metres(unit)};
  Scene scene{};
  spec::Materials spec;
  (void)schema::read(materials, spec::materials(), &spec, diagnostics);
  description::build_materials(spec, context, scene);
  if (diagnostics.has_errors()) return std::nullopt;
  const Material* material = chosen(scene.materials, material_path.name, materials.where, diagnostics);
  return material ? std::optional(*material) : std::nullopt;
}

}  // namespace abbe

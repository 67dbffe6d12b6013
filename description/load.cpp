#include "description/load.h"

#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "description/material.h"
#include "description/scene.h"
#include "description/sensor.h"
#include "io/schema/documentation.h"
#include "io/schema/read.h"
#include "io/schema/write.h"
#include "io/table.h"
#include "io/text.h"
#include "materials/index/library.h"

namespace abbe {
namespace {

// Splits "FILE" or "FILE:NAME" into file and name, which is empty if it is not given.
std::pair<std::filesystem::path, std::string> split_name(const std::string& words) {
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

namespace description {
namespace {

// Reports a scene of another version. Returns false then, because its other errors would be misleading.
bool check_version(const JsonValue& root, Diagnostics& diagnostics) {
  const JsonValue* json = root.find("abbe");
  const auto* version = json ? std::get_if<double>(&json->value) : nullptr;
  if (!version || *version == spec::kFormatVersion) return true;
  diagnostics.error(json->where, fmt::format("{} version of the scene format (got {}, allowed {})",
                                             *version > spec::kFormatVersion ? "future" : "unknown", *version,
                                             spec::kFormatVersion));
  return false;
}

std::string hash(const SourceText& source, std::span<const Override> overrides, const LoadContext& context) {
  std::string all = sha256(source.text);
  for (const Override& o : overrides) all += sha256(o.pointer) + sha256(o.value);
  for (const std::filesystem::path& path : context.files) {
    std::ifstream stream(path, std::ios::binary);
    all += sha256(std::string(std::istreambuf_iterator<char>(stream), {}));
  }
  return sha256(all);
}

// Reads the text of a scene from a file or from standard input, and counts its memory.
std::shared_ptr<const SourceText> read_source(const std::filesystem::path& path, Diagnostics& diagnostics,
                                              Inputs* inputs) {
  // Text that cannot be read is an error of the scene; a missing file is an error of the caller.
  std::error_code error;
  const bool exists = std::filesystem::is_regular_file(path, error);
  if (exists && inputs) inputs->reserve_memory(path.string(), std::filesystem::file_size(path, error));
  auto source = path == kStandardStream
                    ? read_standard_input(diagnostics, ErrorCode::scene)
                    : read_text(path, diagnostics, exists ? ErrorCode::scene : ErrorCode::input);
  if (source && inputs && path == kStandardStream) inputs->reserve_memory(source->file, source->text.size());
  if (source && inputs && path != kStandardStream) inputs->add_file(path);
  return source;
}

// Parses a text, as far as it has no errors. False if it is not a scene at all.
bool read(const std::shared_ptr<const SourceText>& source, std::span<const Override> overrides,
          LoadContext& context, spec::Scene& spec) {
  MemoryReservation tree(context.inputs, 0);
  std::optional<JsonValue> root = parse_json(source, context.diagnostics, &tree);
  if (!root) return false;
  for (const Override& o : overrides) set_json(*root, o.pointer, o.value, context.diagnostics, o.option_name);
  if (!check_version(*root, context.diagnostics)) return false;
  include_sensor_model(*root, context);
  (void)schema::read(*root, schema::fields_of<spec::Scene>(), &spec, context.diagnostics);
  return true;
}

}  // namespace
}  // namespace description

std::optional<Scene> load_scene(const std::filesystem::path& path, std::span<const Override> overrides,
                                Diagnostics& diagnostics, Inputs* inputs, spec::Scene* spec) {
  const auto source = description::read_source(path, diagnostics, inputs);
  if (!source) return std::nullopt;
  return load_scene(source, path.parent_path(), overrides, diagnostics, inputs, spec);
}

std::optional<Scene> load_scene(const std::shared_ptr<const SourceText>& source,
                                const std::filesystem::path& folder, std::span<const Override> overrides,
                                Diagnostics& diagnostics, Inputs* inputs, spec::Scene* spec) {
  description::LoadContext context{diagnostics, folder, inputs};
  spec::Scene own;
  spec::Scene& scene_spec = spec != nullptr ? *spec : own;
  if (!description::read(source, overrides, context, scene_spec)) return std::nullopt;
  Scene scene = build(scene_spec, context);
  if (diagnostics.has_errors()) return std::nullopt;
  scene.sha256 = description::hash(*source, overrides, context);
  scene.commit();
  return scene;
}

std::optional<MeteredScene> load_meters(const std::filesystem::path& path,
                                        std::span<const Override> overrides, Diagnostics& diagnostics,
                                        Inputs* inputs) {
  const auto source = description::read_source(path, diagnostics, inputs);
  if (!source) return std::nullopt;
  return load_meters(source, path.parent_path(), overrides, diagnostics, inputs);
}

std::optional<MeteredScene> load_meters(const std::shared_ptr<const SourceText>& source,
                                        const std::filesystem::path& folder,
                                        std::span<const Override> overrides, Diagnostics& diagnostics,
                                        Inputs* inputs) {
  MeteredScene scene{{}, {}, folder};
  description::LoadContext context{diagnostics, scene.folder, inputs};
  const auto scene_spec = std::make_shared<spec::Scene>();
  if (!description::read(source, overrides, context, *scene_spec)) return std::nullopt;
  scene.scene_spec = scene_spec;
  scene.meters = build_meters(*scene_spec, context);
  if (scene.meters.empty() && !diagnostics.has_errors())
    diagnostics.error(scene_spec->where, "the scene has no meters");
  return diagnostics.has_errors() ? std::nullopt : std::optional(std::move(scene));
}

std::optional<Scene> scene_of(const MeteredScene& scene, const Meter& meter, Diagnostics& diagnostics,
                              Inputs* inputs) {
  description::LoadContext context{diagnostics, scene.folder, inputs};
  Scene built = build(*scene.scene_spec, context, &meter);
  if (diagnostics.has_errors()) return std::nullopt;
  built.commit();
  return built;
}

std::optional<std::string> canonical_scene(const std::filesystem::path& path,
                                           std::span<const Override> overrides, Diagnostics& diagnostics,
                                           Inputs* inputs) {
  spec::Scene spec;
  if (!load_scene(path, overrides, diagnostics, inputs, &spec)) return std::nullopt;
  std::string text = to_lines(schema::write(spec), kJsonWidth);
  // Overrides may nest JSON deeper than a file may be.
  const auto source = std::make_shared<const SourceText>(SourceText{path.string(), text});
  MemoryReservation tree_memory(inputs, 0);
  if (!parse_json(source, diagnostics, &tree_memory)) return std::nullopt;
  return text;
}

std::string scene_schema() {
  return to_lines(schema::json_schema(schema::fields_of<spec::Scene>()), kJsonWidth);
}

std::string scene_guide(const std::string& guide) {
  return schema::with_tables(guide, schema::fields_of<spec::Scene>());
}

std::optional<Material> load_material(const std::string& words, Diagnostics& diagnostics, Inputs* inputs) {
  const bool in_place = words.starts_with('{');
  const auto [path, name] = split_name(in_place ? "" : words);
  const auto source = in_place ? std::make_shared<const SourceText>(SourceText{"MATERIAL", words})
                               : read_text(path, diagnostics);
  if (!source) return std::nullopt;
  std::optional<JsonValue> root = parse_json(source, diagnostics);
  if (!root) return std::nullopt;
  spec::Unit unit{};
  if (const JsonValue* units = root->find("units"))
    (void)schema::read(*units, spec::units(), &unit, diagnostics);
  const JsonValue materials = materials_of(*std::move(root));
  if (inputs && !in_place) inputs->add_file(path);
  description::LoadContext context{diagnostics, path.parent_path(), inputs, spec::metres(unit)};
  Scene scene{};
  spec::Materials spec;
  (void)schema::read(materials, spec::materials(), &spec, diagnostics);
  description::build_materials(spec, context, scene);
  if (diagnostics.has_errors()) return std::nullopt;
  const Material* material = chosen(scene.materials, name, materials.where, diagnostics);
  return material ? std::optional(*material) : std::nullopt;
}

}  // namespace abbe

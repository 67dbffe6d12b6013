#include "description/load.h"

#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "description/scene.h"
#include "description/sensor_model.h"
#include "io/schema/read.h"
#include "io/standard_stream.h"
#include "io/table.h"
#include "io/text.h"
#include "materials/index/library.h"

namespace abbe {
namespace description {
namespace {

// False for a scene of another version, whose other errors are not ours to tell.
bool check_version(const JsonValue& root, Diagnostics& diagnostics) {
  const JsonValue* json = root.find("abbe");
  const auto* version = json ? std::get_if<double>(&json->value) : nullptr;
  if (!version || *version == spec::kFormatVersion) return true;
  const std::string_view what = *version > spec::kFormatVersion ? "future version of the scene format"
                                                                : "no version of the scene format";
  diagnostics.error(json->where,
                    fmt::format("{} (got {}, allowed {})", what, *version, spec::kFormatVersion));
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

// The text of a scene, from a file or from standard input; its memory counts from now on.
std::shared_ptr<const SourceText> read_source(const std::filesystem::path& path, Diagnostics& diagnostics,
                                              Inputs* inputs) {
  // Words that cannot be read are the scene's fault; a file that is not there is the caller's.
  std::error_code error;
  const bool there = std::filesystem::is_regular_file(path, error);
  if (there && inputs) inputs->take_memory(path.string(), std::filesystem::file_size(path, error));
  auto source = path == kStandardStream
                    ? read_standard_input(diagnostics, ErrorCode::scene)
                    : read_text(path, diagnostics, there ? ErrorCode::scene : ErrorCode::input);
  if (source && inputs && path == kStandardStream) inputs->take_memory(source->file, source->text.size());
  if (source && inputs && path != kStandardStream) inputs->add_file(path);
  return source;
}

// What a text says, in so far as it is sound; false for what is no scene at all.
bool read(const std::shared_ptr<const SourceText>& source, std::span<const Override> overrides,
          LoadContext& context, spec::Scene& said) {
  HeldMemory tree(context.inputs, 0);
  std::optional<JsonValue> root = parse_json(source, context.diagnostics, &tree);
  if (!root) return false;
  for (const Override& o : overrides) set_json(*root, o.pointer, o.value, context.diagnostics, o.said_by);
  if (!check_version(*root, context.diagnostics)) return false;
  include_sensor_model(*root, context);
  (void)schema::read(*root, schema::fields_of<spec::Scene>(), &said, context.diagnostics);
  return true;
}

}  // namespace

std::optional<std::filesystem::path> LoadContext::file(const std::string& name, const SourcePosition& where) {
  if (name.find("://") != std::string::npos) {
    diagnostics.error(where, fmt::format("expected a file (got the URL \"{}\")", name), ErrorCode::input);
    return std::nullopt;
  }
  remember(folder / name);
  return files.back();
}

void LoadContext::remember(const std::filesystem::path& file) {
  files.push_back(file);
  if (inputs != nullptr) inputs->add_file(file);
}

void LoadContext::take_memory(const std::string& what, std::size_t bytes) const {
  if (inputs != nullptr) inputs->take_memory(what, bytes);
}

std::optional<std::string> LoadContext::table(const std::string& name, const SourcePosition& where) {
  const std::size_t end = user_table_end(name);  // which a column may follow
  if (end == std::string::npos && !name.ends_with(".json") && !is_refractiveindex_info(name)) return name;
  const auto path = file(name.substr(0, end), where);
  if (!path) return std::nullopt;
  return path->string() + name.substr(std::min(end, name.size()));
}

}  // namespace description

std::optional<Scene> load_scene(const std::filesystem::path& path, std::span<const Override> overrides,
                                Diagnostics& diagnostics, Inputs* inputs, spec::Scene* asked) {
  const auto source = description::read_source(path, diagnostics, inputs);
  if (!source) return std::nullopt;
  return load_scene(source, path.parent_path(), overrides, diagnostics, inputs, asked);
}

std::optional<Scene> load_scene(const std::shared_ptr<const SourceText>& source,
                                const std::filesystem::path& folder, std::span<const Override> overrides,
                                Diagnostics& diagnostics, Inputs* inputs, spec::Scene* asked) {
  description::LoadContext context{diagnostics, folder, inputs};
  spec::Scene own;
  spec::Scene& said = asked != nullptr ? *asked : own;
  if (!description::read(source, overrides, context, said)) return std::nullopt;
  Scene scene = build(said, context);
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
  const auto said = std::make_shared<spec::Scene>();
  if (!description::read(source, overrides, context, *said)) return std::nullopt;
  scene.said = said;
  scene.meters = build_meters(*said, context);
  if (scene.meters.empty() && !diagnostics.has_errors())
    diagnostics.error(said->where, "the scene has no meters");
  return diagnostics.has_errors() ? std::nullopt : std::optional(std::move(scene));
}

std::optional<Scene> scene_of(const MeteredScene& scene, const Meter& meter, Diagnostics& diagnostics,
                              Inputs* inputs) {
  description::LoadContext context{diagnostics, scene.folder, inputs};
  Scene built = build(*scene.said, context, &meter);
  if (diagnostics.has_errors()) return std::nullopt;
  built.commit();
  return built;
}

}  // namespace abbe

#include "description/sensor_model.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/json_values.h"
#include "io/text.h"

namespace abbe::description {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKey = "model";
constexpr std::string_view kExtension = ".json";

// Keys that set the same property: one of them in a scene replaces all of them in a file.
constexpr std::array<std::string_view, 9> kCounts{"channels",
                                                  "camera",
                                                  "observer",
                                                  "spectral",
                                                  "mosaic",
                                                  "response",
                                                  "quantum_efficiency",
                                                  "peak_quantum_efficiency",
                                                  "electrons_per_lx_s"};
constexpr std::array<std::string_view, 4> kWhatCounts{"channels", "camera", "observer", "spectral"};
constexpr std::array<std::string_view, 2> kScale{"peak_quantum_efficiency", "electrons_per_lx_s"};
constexpr std::array<std::string_view, 2> kConversion{"gain_e_per_dn", "iso"};

std::vector<std::string> shipped_models() {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(data_directory() / "sensor", missing))
    if (entry.path().extension() == kExtension) names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<fs::path> model_file(const std::string& name, const SourcePosition& where,
                                   LoadContext& context) {
  if (name.ends_with(kExtension)) return context.file(name, where);
  const std::vector<std::string> names = shipped_models();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    context.diagnostics.error(where, unknown_name("sensor", name, names));
    return std::nullopt;
  }
  context.remember(data_directory() / "sensor" / (name + std::string(kExtension)));
  return context.files.back();
}

// The member `sensor` of a model file. Reports missing keys, including those of its provenance.
std::optional<JsonValue> read_model(const fs::path& path, LoadContext& context) {
  const auto source = read_text(path, context.diagnostics);
  std::optional<JsonValue> root = source ? parse_json(source, context.diagnostics) : std::nullopt;
  if (!root) return std::nullopt;
  bool complete = true;
  for (const char* key : {"title", "source", "status", "sensor"})
    if (root->find(key) == nullptr) {
      context.diagnostics.error(root->where, fmt::format("missing key \"{}\"", key), ErrorCode::input);
      complete = false;
    }
  return complete ? std::optional(std::move(*root->find("sensor"))) : std::nullopt;
}

bool has_any(const JsonValue& object, std::span<const std::string_view> keys) {
  return std::any_of(keys.begin(), keys.end(), [&](auto key) { return object.find(key) != nullptr; });
}

// Keys of the file that the scene's sensor replaces together.
std::span<const std::string_view> replaced_by(const JsonValue& sensor) {
  if (has_any(sensor, kWhatCounts)) return kCounts;
  if (has_any(sensor, kScale)) return kScale;
  return {};
}

// Adds to `own` the members of `file` that it lacks, except those in `replaced`.
void complete(JsonValue& own, JsonValue& file, std::span<const std::string_view> replaced) {
  auto* const members = std::get_if<JsonValue::Object>(&file.value);
  auto* const mine = std::get_if<JsonValue::Object>(&own.value);
  if (members == nullptr || mine == nullptr) return;
  for (JsonValue::Member& member : *members)
    if (own.find(member.first) == nullptr &&
        std::find(replaced.begin(), replaced.end(), member.first) == replaced.end())
      mine->push_back(std::move(member));
}

}  // namespace

void include_sensor_model(JsonValue& scene, LoadContext& context) {
  JsonValue* const sensor = scene.find("sensor");
  const JsonValue* const model = sensor != nullptr ? sensor->find(kKey) : nullptr;
  const auto* const name = model != nullptr ? std::get_if<std::string>(&model->value) : nullptr;
  if (name == nullptr) return;  // Other values are reported when the scene is read.
  const auto path = model_file(*name, model->where, context);
  std::optional<JsonValue> file = path ? read_model(*path, context) : std::nullopt;
  if (!file) return;
  JsonValue* const own = sensor->find("readout");
  JsonValue* const others = file->find("readout");
  if (own != nullptr && others != nullptr)
    complete(*own, *others,
             has_any(*own, kConversion) ? std::span<const std::string_view>(kConversion)
                                        : std::span<const std::string_view>());
  complete(*sensor, *file, replaced_by(*sensor));
}

}  // namespace abbe::description

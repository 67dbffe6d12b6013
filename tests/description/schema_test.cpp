#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"
#include "io/data_directory.h"
#include "spectral/colorimetry.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;
using SchemaTest = testing::DescriptionTest;
using testing::file_text;
using testing::Loaded;

// Every key of every object below `json` that is described by the format: not the names users choose.
void collect_keys(const JsonValue& json, std::set<std::string>& keys) {
  if (const auto* array = std::get_if<JsonValue::Array>(&json.value))
    for (const JsonValue& element : *array) collect_keys(element, keys);
  if (const auto* object = std::get_if<JsonValue::Object>(&json.value))
    for (const auto& [key, value] : *object) {
      const std::string parent = json.where.pointer;
      if (parent != "/materials" && parent != "/sensor/channels" && parent != "/objects" &&
          !parent.ends_with("/weights"))
        keys.insert(key);
      collect_keys(value, keys);
    }
}

void collect_properties(const JsonValue& schema, std::set<std::string>& names) {
  if (const auto* array = std::get_if<JsonValue::Array>(&schema.value))
    for (const JsonValue& element : *array) collect_properties(element, names);
  if (const auto* object = std::get_if<JsonValue::Object>(&schema.value))
    for (const auto& [key, value] : *object) {
      if (const auto* members = std::get_if<JsonValue::Object>(&value.value); members && key == "properties")
        for (const auto& [name, property] : *members) names.insert(name);
      collect_properties(value, names);
    }
}

const JsonValue& member(const JsonValue& json, const std::string& key) {
  static const JsonValue kNone{};
  const JsonValue* found = json.find(key);
  return found ? *found : kNone;
}
const JsonValue::Array& list(const JsonValue& json) {
  static const JsonValue::Array kNone;
  const auto* array = std::get_if<JsonValue::Array>(&json.value);
  return array ? *array : kNone;
}
bool has_all(const JsonValue& json, const JsonValue& keys) {
  return std::ranges::all_of(list(keys), [&](const JsonValue& key) {
    return json.find(std::get<std::string>(key.value)) != nullptr;
  });
}

// Whether the schema `root` allows which keys stand beside each other in `json`, its part `schema` being
// about that; of the values nothing is asked.
bool allows(const JsonValue& root, const JsonValue& schema, const JsonValue& json) {
  const auto here = [&](const JsonValue& part) { return allows(root, part, json); };
  if (const JsonValue* reference = schema.find("$ref")) {
    const std::string name = std::get<std::string>(reference->value).substr(std::string("#/$defs/").size());
    if (!here(member(member(root, "$defs"), name))) return false;
  }
  if (!has_all(json, member(schema, "required"))) return false;
  if (const auto* needed = std::get_if<JsonValue::Object>(&member(schema, "dependentRequired").value))
    for (const auto& [key, keys] : *needed)
      if (json.find(key) && !has_all(json, keys)) return false;
  if (const auto* parts = std::get_if<JsonValue::Object>(&member(schema, "properties").value))
    for (const auto& [key, part] : *parts)
      if (const JsonValue* value = json.find(key); value && !allows(root, part, *value)) return false;
  const JsonValue::Array& choices = list(member(schema, "oneOf"));
  return std::ranges::all_of(list(member(schema, "allOf")), here) &&
         (choices.empty() || std::ranges::count_if(choices, here) == 1);
}

// What only one of two sets holds.
std::string different(const std::set<std::string>& a, const std::set<std::string>& b) {
  std::vector<std::string> names;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(names));
  return fmt::format("{}", fmt::join(names, " "));
}

JsonValue parsed(const std::string& text) {
  Diagnostics diagnostics;
  auto json = parse_json(std::make_shared<const SourceText>(SourceText{"text", text}), diagnostics);
  EXPECT_TRUE(json) << diagnostics.text();
  return json.value_or(JsonValue{});
}

std::vector<fs::path> shipped_scenes() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(data_directory() / "scenes"))
    if (entry.path().extension() == ".json") paths.push_back(entry.path());
  return paths;
}

std::vector<std::string> guide_examples() {
  const std::string guide = file_text(data_directory().parent_path() / "docs" / "scene.md");
  const std::regex fence("```jsonc\n([^`]*)```");
  std::vector<std::string> examples;
  for (std::sregex_iterator i(guide.begin(), guide.end(), fence), end; i != end; ++i)
    examples.push_back((*i)[1]);
  return examples;
}

TEST_F(SchemaTest, ShippedScenesLoad) {
  ASSERT_GE(shipped_scenes().size(), 5U);
  for (const fs::path& path : shipped_scenes()) {
    Diagnostics diagnostics;
    EXPECT_TRUE(load_scene(path, {}, diagnostics)) << diagnostics.text();
  }
}

TEST_F(SchemaTest, CornellBoxIsSeenAsMeasured) {
  Diagnostics diagnostics;
  const auto scene = load_scene(data_directory() / "scenes" / "cornell.json", {}, diagnostics);
  ASSERT_TRUE(scene) << diagnostics.text();
  const auto& lens = std::get<Pinhole>(scene->camera.kind);
  const double half = scene->camera.width * scene->camera.pixel_pitch / 2;
  EXPECT_NEAR(2 * std::atan(half / lens.image_distance) * 180 / std::numbers::pi, 39.3077, 1e-4);
  EXPECT_NEAR(photometric(scene->lights.at(0).emission.curve()), kLuminousEfficacy * 20, 1e-6);
  EXPECT_EQ(scene->triangle_count(), 32U);
}

TEST_F(SchemaTest, LightsSayTheirStrengthOnceAsTheLoaderHasIt) {
  const JsonValue schema = parsed(file_text(data_directory().parent_path() / "docs" / "scene.schema.json"));
  const JsonValue& lights = member(member(member(schema, "properties"), "lights"), "items");
  const std::string sun = R"("sun": {"towards": [0, 0, 1])";
  const std::string beam = R"("directional": {"towards": [0, 0, 1])";
  const std::string quad = R"("quad": {"corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]})";
  const std::string emission = R"(, "emission": {"illuminant": "A", "irradiance": 1)";
  for (const auto& [light, allowed] :
       std::vector<std::pair<std::string, bool>>{{sun + "}", false},
                                                 {sun + R"(, "illuminance": 1})", true},
                                                 {sun + R"(, "irradiance": 1, "illuminance": 1})", false},
                                                 {sun + "}" + emission + "}", true},
                                                 {sun + R"(, "illuminance": 1})" + emission + "}", false},
                                                 {beam + "}", false},
                                                 {beam + R"(, "irradiance": 1})", true},
                                                 {beam + R"(, "irradiance": 1})" + emission + "}", false},
                                                 {quad + emission + "}", false},
                                                 {quad + emission + R"(, "distance": 1})", true},
                                                 {quad, false}}) {
    EXPECT_EQ(allows(schema, lights, parsed("{" + light + "}")), allowed) << light;
    EXPECT_EQ(load(R"({"lights": [{)" + light + "}]}").scene.has_value(), allowed) << light;
  }
}

// The schema, the guide, the shipped scenes and the loader know the same keys.
TEST_F(SchemaTest, SchemaKnowsEveryKey) {
  std::set<std::string> used;
  ASSERT_GE(guide_examples().size(), 10U);
  for (const std::string& example : guide_examples()) {
    const Loaded loaded = load(example);
    EXPECT_TRUE(loaded.scene) << example << loaded.text();
    collect_keys(parsed(example), used);
  }
  for (const fs::path& path : shipped_scenes()) collect_keys(parsed(file_text(path)), used);
  std::set<std::string> described;
  collect_properties(parsed(file_text(data_directory().parent_path() / "docs" / "scene.schema.json")),
                     described);
  EXPECT_EQ(different(used, described), "") << "used by examples that load, and described by the schema";

  // What the loader asks for, read from its own text.
  std::set<std::string> asked;
  const std::regex getter(
      R"re((?:find|require|number|integer|string|boolean_or|numbers|number_or|require_\w+|read_point|read_direction|field|under|beside|describe_lamp|amount|read)(?:<[^>]*>)?\(\s*(?:\w+,\s*)?"([\w]+)")re");
  const std::regex choice(R"re((?:exactly_one\(\s*|Scales)\{([^}]*)\})re");
  const std::regex word(R"re("(\w+)")re");
  const std::regex reader(R"re(\{"(\w+)", read_\w+\})re");  // of the table of materials
  const auto scan = [](const std::string& text, const std::regex& pattern, auto&& take) {
    for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i) take((*i)[1].str());
  };
  const fs::path tree = data_directory().parent_path();
  std::vector<fs::path> readers{tree / "sensor" / "readout" / "readout_json.cpp"};
  for (const auto& entry : fs::directory_iterator(tree / "description"))
    if (entry.is_regular_file()) readers.push_back(entry.path());
  for (const fs::path& reader_file : readers) {
    const std::string source = file_text(reader_file);
    const auto take = [&](const std::string& key) { asked.insert(key); };
    scan(source, getter, take);
    scan(source, reader, take);
    scan(source, choice, [&](const std::string& list) { scan(list, word, take); });
  }
  asked.insert("$schema");
  EXPECT_EQ(different(asked, described), "") << "asked for by the loader, and described by the schema";
}

}  // namespace
}  // namespace abbe

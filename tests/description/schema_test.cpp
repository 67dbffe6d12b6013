#include <cctype>
#include <cmath>
#include <numbers>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"
#include "description/load.h"
#include "description/scene.h"
#include "io/data_directory.h"
#include "io/schema/documentation.h"
#include "io/schema/read.h"
#include "io/schema/write.h"
#include "spectral/colorimetry.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;
using SchemaTest = test::DescriptionTest;
using test::completed;
using test::file_text;
using test::guide_examples;
using test::Loaded;
using test::scene_files;
using test::scene_guide_text;

TEST_F(SchemaTest, ShippedScenesLoad) {
  ASSERT_GE(scene_files("scenes").size(), 5U);
  for (const fs::path& path : scene_files("scenes")) {
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

TEST_F(SchemaTest, AMisspeltKeyStillTellsTheForm) {
  const std::string film = R"({"materials": {"m": {"film": {"layers": [{"repeat": 3, "layer": []}]}}}})";
  const std::string complaints = load(film).text();
  EXPECT_NE(complaints.find("unknown key \"layer\"; did you mean \"layers\"?"), std::string::npos)
      << complaints;
  EXPECT_EQ(complaints.find("unknown key \"repeat\""), std::string::npos) << complaints;
}

TEST_F(SchemaTest, LightsSayTheirStrengthOnce) {
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
                                                 {quad, false}})
    EXPECT_EQ(load(R"({"lights": [{)" + light + "}]}").scene.has_value(), allowed) << light;
}

// Keys to which tables refer by name are keys of these tables.
TEST_F(SchemaTest, TablesHoldTogether) {
  const auto has = [](const schema::Fields& fields, std::string_view key) {
    const auto keys = schema::keys_of(std::vector{&fields});
    return std::any_of(keys.begin(), keys.end(), [&](const schema::Key& known) { return known.name == key; });
  };
  for (const schema::StructPath& place : schema::structs_below(schema::fields_of<spec::Scene>())) {
    for (const std::string_view path : place.fields->any_of)
      EXPECT_TRUE(has(*place.fields, path.substr(0, path.find('/')))) << path;
    for (const schema::Field& field : place.fields->fields)
      if (const auto* group = std::get_if<schema::OneOf>(field.content.get()))
        for (const schema::Choice& choice : group->choices)
          if (!choice.nested) {
            const auto& beside = std::get<schema::Struct>(choice.alternative.type->variant).fields();
            EXPECT_TRUE(has(beside, choice.key)) << choice.key;
            for (const std::string_view path : beside.any_of)
              EXPECT_TRUE(has(beside, path.substr(0, path.find('/')))) << path;
          }
  }
}

TEST_F(SchemaTest, TheSchemaIsThatOfTheTables) {
  EXPECT_TRUE(file_text(data_directory().parent_path() / "docs" / "reference" / "scene.schema.json") ==
              scene_schema())
      << "stale: build the target `reference`";
}

TEST_F(SchemaTest, TheGuidesTablesAreWrittenFromThoseOfTheFields) {
  EXPECT_EQ(scene_guide_text(), scene_guide(scene_guide_text())) << "stale: build the target `reference`";
  EXPECT_THROW((void)scene_guide("<!-- keys: nothing -->\n<!-- end -->\n"), Error);
  EXPECT_THROW((void)scene_guide("<!-- keys: camera -->\n"), Error);
}

TEST_F(SchemaTest, TheGuideTellsEveryKeyAndItsLinksLeadSomewhere) {
  const std::string guide = scene_guide_text();
  for (const std::string& key : schema::all_keys(schema::fields_of<spec::Scene>()))
    EXPECT_TRUE(guide.find(fmt::format("`{}` | ", key)) != std::string::npos ||
                guide.find(fmt::format("/{}` | ", key)) != std::string::npos)
        << key;
  std::string headings;
  for (const char c : guide) headings += c == ' ' ? '-' : static_cast<char>(std::tolower(c));
  const std::regex link("\\]\\(#([^)]*)\\)");
  std::set<std::string> anchors;
  for (std::sregex_iterator i(guide.begin(), guide.end(), link), end; i != end; ++i) anchors.insert((*i)[1]);
  EXPECT_GE(anchors.size(), 15U);
  for (const std::string& anchor : anchors)
    EXPECT_NE(headings.find("#-" + anchor + '\n'), std::string::npos) << anchor;
}

TEST_F(SchemaTest, ExamplesOfTheGuideLoad) {
  ASSERT_GE(guide_examples().size(), 10U);
  for (const std::string& example : guide_examples()) {
    const Loaded loaded = load(example);
    EXPECT_TRUE(loaded.scene) << example << loaded.text();
  }
}

// A written scene reads back as the same scene, to the last digit.
TEST_F(SchemaTest, ScenesSurviveBeingWritten) {
  const auto said = [](const std::string& text) {
    Diagnostics diagnostics;
    const auto json = parse_json(std::make_shared<const SourceText>(SourceText{"text", text}), diagnostics);
    const auto scene = json ? schema::read<spec::Scene>(*json, diagnostics) : std::nullopt;
    EXPECT_TRUE(scene) << diagnostics.text();
    return scene ? to_text(schema::write(*scene)) : "";
  };
  std::vector<std::string> texts;
  for (const fs::path& path : scene_files("scenes")) texts.push_back(file_text(path));
  for (const std::string& example : guide_examples()) texts.push_back(completed(example));
  for (const std::string& text : texts) {
    const std::string once = said(text);
    EXPECT_EQ(said(once), once);
    EXPECT_NE(once, "");
  }
}

}  // namespace
}  // namespace abbe

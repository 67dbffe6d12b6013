#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"

// Scene files that `abbe convert` writes.

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

const std::string kSquare =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n50 0 0\n0 0 50\n3 0 1 2\n";

// A scene in its own folder that names a file.
std::string meshed() {
  fs::create_directories(scratch() / "meshed");
  (void)scratch().write("meshed/square.ply", kSquare);
  return scratch()
      .write("meshed/scene.json", scene_text(R"("white": {"diffuse": {"reflectance": 0.1}})",
                                             R"({"mesh": "square.ply", "material": "white"})"))
      .string();
}

// Planes of the rendered scene, one after the other.
std::vector<float> rendered(const std::string& arguments) {
  const Outcome run = abbe("render " + arguments + " --quiet -o " + file("convert.exr"));
  EXPECT_EQ(run.code, 0) << run.err;
  std::vector<float> values;
  for (const ImageChannel& channel : read_exr(scratch() / "convert.exr").channels)
    values.insert(values.end(), channel.values.begin(), channel.values.end());
  return values;
}

TEST(Convert, WhatIsWrittenRendersTheSame) {
  const std::string out = file("meshed/written.json");
  const std::string set = " --set '/$schema=x.json' --set /materials/white/diffuse/reflectance=0.7";
  const Outcome run = abbe("convert " + meshed() + set + " -o " + out);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out + run.err, "");
  EXPECT_TRUE(read_file(out).starts_with("{\n  \"$schema\": \"x.json\",\n  \"abbe\": 1,\n"))
      << read_file(out);
  EXPECT_EQ(rendered(out), rendered(meshed() + set));
  EXPECT_EQ(abbe("convert " + out).out, read_file(out));
  EXPECT_EQ(shell("cd " + file("meshed") + "; " ABBE_BINARY " convert - -o - < written.json").out,
            read_file(out));
}

// A value of --set may be nested as deeply as a file, but is deeper still in the scene.
TEST(Convert, NothingIsWrittenThatCannotBeRead) {
  std::string curve = "0.5";
  for (int level = 0; level < 253; ++level) curve = R"({"scale":1,"of":)" + curve + "}";
  const std::string out = file("meshed/deep.json");
  const Outcome run =
      abbe("convert " + meshed() + " --set '/materials/white/diffuse/reflectance=" + curve + "' -o " + out);
  EXPECT_EQ(run.code, 3) << run.err;
  EXPECT_NE(run.err.find("nesting too deep"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(out));
}

TEST(Convert, FilesAreLookedForWhereTheyWere) {
  const Outcome run = abbe("convert " + meshed() + " -o " + file("moved.json"));
  EXPECT_EQ(run.code, 2) << run.err;
  const std::string why =
      "is in another folder than the scene, which names the file " + file("meshed/square.ply");
  EXPECT_NE(run.err.find(why), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(file("moved.json")));
  const std::string here = "cd " + file("meshed") + "; " ABBE_BINARY " convert ";
  EXPECT_EQ(shell(here + "scene.json -o ../moved.json").code, 2);
  EXPECT_EQ(shell(here + "- -o ../moved.json < scene.json").code, 2);
  EXPECT_EQ(shell(here + "../meshed/scene.json -o here.json").code, 0);
  const std::string absolute = " --set /shapes/0/mesh=" + file("meshed/square.ply");
  EXPECT_EQ(shell(here + "scene.json -o ../moved.json" + absolute).code, 0);
  EXPECT_EQ(abbe("convert " + ball() + " -o " + file("meshed/ball.json")).code, 0);  // names no file
}

TEST(Convert, RefusesAsOtherCommandsDo) {
  const std::string bad = scratch().write("bad.json", "{\n  \"abbe\": 1,\n  \"camra\": {}\n}\n").string();
  EXPECT_EQ(abbe("convert " + bad).code, 3);
  EXPECT_EQ(abbe("convert " + bad).err, abbe("info " + bad).err);
  EXPECT_EQ(abbe("convert /nowhere/scene.json").code, 4);
  EXPECT_EQ(abbe("convert " + ball() + " -o scene.exr").code, 2);
  EXPECT_EQ(abbe("convert " + ball() + " -o " + file("none/scene.json")).code, 5);
  EXPECT_EQ(abbe("convert " + ball() + " -o " + ball()).code, 2);
  EXPECT_EQ(read_file(ball()), ball_scene());
}

TEST(Convert, ScenesOfOtherRenderers) {
  (void)scratch().write("ball.pbrt",
                        "Scale -1 1 1\nCamera \"perspective\"\nWorldBegin\nMaterial \"hair\"\nTranslate 0 0 "
                        "9\nShape \"sphere\"\n");
  (void)scratch().write("map.json", R"({"hair": {"mirror": {"reflectance": 0.5}}})");
  const std::string out = file("ball_pbrt.json");
  const Outcome run =
      abbe("convert " + file("ball.pbrt") + " --materials " + file("map.json") + " -o " + out);
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.err.find("ball.pbrt:4:1: warning: a material \"hair\" is not supported"), std::string::npos)
      << run.err;
  EXPECT_NE(read_file(out).find("//   "), std::string::npos);
  EXPECT_NE(read_file(out).find("\"mirror\""), std::string::npos);
  EXPECT_EQ(abbe("info " + out).code, 0);
  EXPECT_EQ(abbe("convert " + out + " --materials " + file("map.json")).code, 2);
  EXPECT_EQ(abbe("convert " + file("ball.pbrt") + " --set /units=mm").code, 2);
  EXPECT_EQ(abbe("convert /nowhere/scene.pbrt").code, 4);
}

/// A text that is repeated many times in a small scene.
std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

// The limits are 4 GB of address space and ten seconds. None of these scenes may need more.
void expect_too_much(const std::string& name, const std::string& scene, const std::string& limit) {
  (void)scratch().write(name, scene);
  const Outcome run = shell("ulimit -v 4000000; timeout 10 " ABBE_BINARY " convert " + file(name) + " -o " +
                            file("too_much.json") + " --max-memory " + limit);
  EXPECT_EQ(run.code, 6) << name << '\n' << run.err.substr(0, 500);
  EXPECT_NE(run.err.find(name), std::string::npos) << run.err.substr(0, 500);
}

const std::string kMitsubaView =
    R"(<sensor type="perspective"><float name="fov" value="40"/></sensor><integrator type="path"/>)";
const std::string kPbrtView =
    "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n";

// Each default expands to ten references to the previous one.
std::string nested_defaults(int levels) {
  std::string scene = R"(<scene version="3.0.0"><default name="a0" value="xxxxxxxxxx"/>)";
  for (int i = 1; i <= levels; ++i)
    scene += fmt::format(R"(<default name="a{}" value="{}"/>)", i, repeated(fmt::format("$a{}", i - 1), 10));
  return scene + fmt::format(R"(<string name="s" value="$a{}"/></scene>)", levels);
}

TEST(Convert, DefaultsOfMitsubaDoNotMultiplyWithoutEnd) {
  expect_too_much("bomb.xml", nested_defaults(9), "50M");
  expect_too_much("bomb.xml", nested_defaults(9), "3G");
  const Outcome run = abbe("convert " + scratch().write("defaults.xml", nested_defaults(4)).string());
  EXPECT_EQ(run.code, 3) << run.err;  // 100,000 letters are allowed
  EXPECT_NE(run.err.find("the scene has no sensor"), std::string::npos) << run.err;
}

std::string mitsuba_scene(const std::string& elements) {
  return R"(<scene version="3.0.0">)" + kMitsubaView + elements + "</scene>";
}

// Input text, its expansion, and the written text.
TEST(Convert, ScenesOfMitsubaTakeNoMoreMemoryThanAllowed) {
  expect_too_much("values.xml",
                  mitsuba_scene(R"(<default name="a" value=")" + std::string(1000000, 'x') + R"("/>)" +
                                repeated(R"(<string name="s" value="$a"/>)", 1000)),
                  "50M");
  expect_too_much("comment.xml", mitsuba_scene("<!--" + std::string(10000000, 'x') + "-->"), "5M");
  expect_too_much("elements.xml", mitsuba_scene(repeated("<a/>", 1000000)), "50M");
  expect_too_much(
      "spheres.xml",
      mitsuba_scene(R"(<emitter type="constant"/>)" + repeated(R"(<shape type="sphere"/>)", 20000)), "20M");
  (void)scratch().write("part_of_includes.xml", mitsuba_scene(repeated(R"(<shape type="cube"/>)", 1000)));
  expect_too_much("includes.xml",
                  mitsuba_scene(repeated(R"(<include filename="part_of_includes.xml"/>)", 9000)), "50M");
}

TEST(Convert, ScenesOfPbrtTakeNoMoreMemoryThanAllowed) {
  const std::string many = R"("float many" [)" + repeated("0 ", 100000) + "]\n";
  std::string materials;
  for (int i = 0; i < 500; ++i)
    materials += fmt::format("MakeNamedMaterial \"m{}\" \"string type\" \"diffuse\"\n", i);
  std::string spectrum;
  for (int i = 0; i < 20000; ++i) spectrum += fmt::format("{} 1 ", 400 + i * 0.01);
  struct Example {
    const char* name;
    const char* limit;  ///< Above the length of the text, except for the first.
    std::string text;
  };
  const std::vector<Example> examples{
      {"comment.pbrt", "5M", repeated("# nothing\n", 1000000)},
      {"numbers.pbrt", "20M", R"(Shape "trianglemesh" "point3 P" [)" + repeated("0 ", 3000000) + "]\n"},
      {"begins.pbrt", "50M", R"(Attribute "shape" )" + many + repeated("AttributeBegin\n", 20000)},
      {"materials.pbrt", "50M", R"(Attribute "material" )" + many + materials},
      {"cylinders.pbrt", "50M", repeated("Shape \"cylinder\"\n", 5000)},
      {"lights.pbrt", "50M",
       R"(Attribute "light" "spectrum L" [)" + spectrum + "]\n" +
           repeated("AreaLightSource \"diffuse\"\nShape \"sphere\"\n", 500)}};
  for (const auto& [name, limit, text] : examples) expect_too_much(name, kPbrtView + text, limit);
}

TEST(Convert, SceneFilesTakeNoMoreMemoryThanAllowed) {
  const std::string values = repeated("0,", 1000000);
  expect_too_much("values.json", scene_text("", "") + "// " + std::string(10000000, 'x'), "5M");
  expect_too_much("tree.json", R"({"abbe": 1, "a": [)" + values + "]}", "50M");
}

TEST(Convert, TakesScenesThatFit) {
  const std::string meshes = kPbrtView + "LightSource \"infinite\"\n" +
                             repeated(
                                 "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" "
                                 "[0 0 0 1 0 0 0 1 0]\n",
                                 100);
  const Outcome run = abbe("convert " + scratch().write("meshes.pbrt", meshes).string() + " --max-memory 5M");
  EXPECT_EQ(run.code, 0) << run.err;
}

}  // namespace
}  // namespace abbe::test

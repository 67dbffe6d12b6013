#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "io/exr.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"

// What `abbe convert` writes of a scene.

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

const std::string kSquare =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n50 0 0\n0 0 50\n3 0 1 2\n";

// A scene that names a file, in a folder of its own.
std::string meshed() {
  fs::create_directories(scratch() / "meshed");
  (void)scratch().write("meshed/square.ply", kSquare);
  return scratch()
      .write("meshed/scene.json", scene_text(R"("white": {"diffuse": {"reflectance": 0.1}})",
                                             R"({"mesh": "square.ply", "material": "white"})"))
      .string();
}

// The planes of what it renders, one after the other.
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

// A value on the command line may nest as deep as a file, and stands deeper than that in the scene.
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
  const std::string why = "is in another folder than the scene, which names " + file("meshed/square.ply");
  EXPECT_NE(run.err.find(why), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(file("moved.json")));
  const std::string here = "cd " + file("meshed") + "; " ABBE_BINARY " convert ";
  EXPECT_EQ(shell(here + "scene.json -o ../moved.json").code, 2);
  EXPECT_EQ(shell(here + "- -o ../moved.json < scene.json").code, 2);
  EXPECT_EQ(shell(here + "../meshed/scene.json -o here.json").code, 0);
  const std::string absolute = " --set /shapes/0/mesh=" + file("meshed/square.ply");
  EXPECT_EQ(shell(here + "scene.json -o ../moved.json" + absolute).code, 0);
  EXPECT_EQ(abbe("convert " + ball() + " -o " + file("meshed/ball.json")).code, 0);  // names none
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
  EXPECT_NE(run.err.find("ball.pbrt:4:1: warning: a material \"hair\" has no counterpart here"),
            std::string::npos)
      << run.err;
  EXPECT_NE(read_file(out).find("//   "), std::string::npos);
  EXPECT_NE(read_file(out).find("\"mirror\""), std::string::npos);
  EXPECT_EQ(abbe("info " + out).code, 0);
  EXPECT_EQ(abbe("convert " + out + " --materials " + file("map.json")).code, 2);
  EXPECT_EQ(abbe("convert " + file("ball.pbrt") + " --set /units=mm").code, 2);
  EXPECT_EQ(abbe("convert /nowhere/scene.pbrt").code, 4);
}

}  // namespace
}  // namespace abbe::test

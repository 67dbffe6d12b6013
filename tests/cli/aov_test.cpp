#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"

// Auxiliary channels of the first surface in each pixel, from the command line to the files.

namespace abbe::test {
namespace {

Outcome rendered_ball(const std::string& name, const std::string& options) {
  return run_render(ball(), file(name), options);
}

TEST(Aov, ChannelsHaveTheNamesThatDenoisersRead) {
  ASSERT_EQ(rendered_ball("aov.exr", "--aov id,normal,albedo,depth").code, 0);
  const Image film = read_exr(file("aov.exr"));
  for (const char* name :
       {"X", "Z", "Variance.X", "Coverage", "depth.Z", "N.X", "N.Y", "N.Z", "Albedo.X", "Albedo.Z", "Id"})
    EXPECT_NE(film.find(name), nullptr) << name;
  EXPECT_EQ(film.find("P.X"), nullptr);
  EXPECT_EQ(film.metadata.at("aov"), "depth,normal,albedo,id");
  EXPECT_EQ(film.metadata.at("shapes"), R"(["ball"])");
  const std::size_t middle = 8 * 24 + 12;
  EXPECT_EQ(film.find("Coverage")->values[middle], 1);
  EXPECT_NEAR(film.find("Albedo.Y")->values[middle], 0.8, 1e-6);
  EXPECT_EQ(film.find("Coverage")->values[0], 0);
}

// A film with auxiliary channels is developed, displayed and compared like one without.
TEST(Aov, TheFilmItselfIsNoOther) {
  ASSERT_EQ(rendered_ball("plain.exr", "").code, 0);
  ASSERT_EQ(
      rendered_ball("with.exr", fmt::format("--aov position,albedo --display {}", file("with.png"))).code, 0);
  const Outcome compared = abbe(fmt::format("compare {} {} --json", file("plain.exr"), file("with.exr")));
  ASSERT_EQ(compared.code, 0) << compared.err;
  EXPECT_EQ(compared.json()["rmse"], 0);
  const auto developed = [](const char* film) {
    const Outcome run = abbe(fmt::format("develop {} --json -o {}", file(film), file("developed.exr")));
    EXPECT_EQ(run.code, 0) << run.err;
    return run.json();
  };
  EXPECT_EQ(developed("with.exr"), developed("plain.exr"));
}

TEST(Aov, PartsOfAnyCropsAndRangesMakeTheFileOfTheWhole) {
  const std::string aov = "--aov depth,shading-normal,id ";
  std::string parts;
  for (const char* cut :
       {"--crop 0,0,7,16", "--crop 7,0,24,16 --sample-range 3:8", "--crop 7,0,24,16 --sample-range 0:3"}) {
    const std::string part = fmt::format("part{}.abbepart", parts.size());
    ASSERT_EQ(rendered_ball(part, aov + cut).code, 0);
    parts += file(part) + " ";
  }
  ASSERT_EQ(rendered_ball("whole.exr", aov).code, 0);
  ASSERT_EQ(abbe(fmt::format("merge {} -o {}", parts, file("sum.exr"))).code, 0);
  EXPECT_EQ(read_file(file("sum.exr")), read_file(file("whole.exr")));
}

// Intensities alone have an albedo. The other Stokes components are signed. The same holds for parts.
TEST(Aov, AlbedoIsThatOfIntensities) {
  const std::string stokes = "--set /sensor/stokes=true --aov albedo ";
  ASSERT_EQ(rendered_ball("stokes.exr", stokes).code, 0);
  const Image film = read_exr(file("stokes.exr"));
  ASSERT_NE(film.find("Albedo.Y"), nullptr);
  EXPECT_NEAR(film.find("Albedo.Y")->values[8 * 24 + 12], 0.8, 1e-6);
  EXPECT_NE(film.find("S1.Y"), nullptr);
  for (const char* signed_plane : {"Albedo.S1.X", "Albedo.S2.Y", "Albedo.S3.Z"})
    EXPECT_EQ(film.find(signed_plane), nullptr) << signed_plane;
  ASSERT_EQ(rendered_ball("a.abbepart", stokes + "--crop 0,0,9,16").code, 0);
  ASSERT_EQ(rendered_ball("b.abbepart", stokes + "--crop 9,0,24,16").code, 0);
  ASSERT_EQ(
      abbe(fmt::format("merge {} {} -o {}", file("a.abbepart"), file("b.abbepart"), file("sum.exr"))).code,
      0);
  EXPECT_EQ(read_file(file("sum.exr")), read_file(file("stokes.exr")));
}

TEST(Aov, AChannelOfTheSensorKeepsItsName) {
  const Outcome run = rendered_ball(
      "id.exr",
      R"(--aov id --set '/sensor={"resolution": [24, 16], "channels": {"Id": {"band": [500, 600]}}}')");
  EXPECT_EQ(run.code, 3);
  EXPECT_NE(run.err.find("a channel has the name of a feature plane (got \"Id\"); rename it"),
            std::string::npos)
      << run.err;
}

// Mesh files may contain names of materials, and so of shapes, with any bytes. A film records bytes that are
// not UTF-8 as U+FFFD.
TEST(Aov, NamesOfLatin1AreTold) {
  (void)scratch().write("latin1.mtl", "newmtl caf\xE9\nKd 0.5 0.5 0.5\nnewmtl b\nKd 0.5 0.5 0.5\n");
  (void)scratch().write("latin1.obj",
                        "mtllib latin1.mtl\nv -9 0 0\nv 9 0 0\nv 0 0 9\nv 0 0 -9\nusemtl caf\xE9\nf 1 2 3\n"
                        "usemtl b\nf 1 2 4\n");
  const auto scene =
      scratch().write("latin1.json", scene_text("", R"({"name": "thing", "mesh": "latin1.obj"})"));
  const Outcome run = run_render(scene.string(), file("latin1.exr"), "--aov id");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(read_exr(file("latin1.exr")).metadata.at("shapes"), "[\"thing/caf\xEF\xBF\xBD\",\"thing/b\"]");
}

TEST(Aov, WhatIsNoFeatureOrAnotherIsRefused) {
  const Outcome unknown = rendered_ball("no.exr", "--aov depth,colour");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(
      unknown.err.find(
          R"(--aov: got "depth,colour", allowed names out of depth, position, normal, shading-normal, albedo, id)"),
      std::string::npos)
      << unknown.err;
  const std::string checkpoint = fmt::format("--checkpoint {} ", file("begun.abbepart"));
  ASSERT_EQ(rendered_ball("begun.exr", checkpoint + "--aov depth --sample-range 0:4").code, 0);
  const Outcome other = rendered_ball("begun.exr", checkpoint + "--resume --aov id --sample-range 0:8");
  EXPECT_EQ(other.code, 4);
  EXPECT_NE(other.err.find("another aov (got depth, allowed id)"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace abbe::test

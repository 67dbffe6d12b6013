#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"

// Films with layers by light and by path length, from the command line to films with other light factors.

namespace abbe::test {
namespace {

// The ball and a lamp, recorded by this sensor.
std::string lit_ball(const std::string& name, const std::string& sensor) {
  std::string text =
      scene_text(R"("white": {"diffuse": {"reflectance": 0.8}})",
                 R"({"name": "ball", "sphere": {"center": [0, 0, 0], "radius": 50}, "material": "white"})");
  const std::string sky = R"({"environment": {})";
  text.replace(
      text.find(sky), sky.size(),
      R"({"name": "lamp 1", "point": {"at": [-200, -200, 100]}, "emission": {"illuminant": "A", "luminous_flux_lm": 4000}},
  {"name": "sky", "environment": {})");
  const std::string seen = R"("observer": "1931")";
  return scratch().write(name, text.replace(text.find(seen), seen.size(), sensor)).string();
}
std::string coloured() {
  return lit_ball("lit.json", R"("observer": "1931")");
}
std::string spectral() {
  return lit_ball("spectral.json", R"("spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 100})");
}

float value(const Image& image, const std::string& channel, std::size_t pixel) {
  const ImageChannel* found = image.find(channel);
  EXPECT_NE(found, nullptr) << channel;
  return found != nullptr ? found->values[pixel] : NAN;
}

// Layers exist for the channels of all sensors.
void expect_sum(const Image& film, const std::vector<std::string>& layers, const std::string& plane) {
  for (std::size_t pixel = 0; pixel < film.pixels(); ++pixel) {
    float sum = 0;
    for (const std::string& layer : layers) sum += value(film, layer + "." + plane, pixel);
    EXPECT_NEAR(sum, value(film, plane, pixel), 1e-5 * std::abs(value(film, plane, pixel))) << plane;
  }
}

TEST(Layers, AddUpInTheFile) {
  ASSERT_EQ(run_render(coloured(), file("lights.exr"), "--layers lights").code, 0);
  const Image lights = read_exr(file("lights.exr"));
  EXPECT_EQ(lights.metadata.at("layers"), "light.lamp_1,light.sky");
  for (const char* plane : {"X", "Y", "Z"}) expect_sum(lights, {"light.lamp_1", "light.sky"}, plane);
  EXPECT_GT(value(lights, "Variance.light.lamp_1.Y", 8 * 24 + 12), 0);
  ASSERT_EQ(run_render(coloured(), file("bounces.exr"), "--layers bounces:2 --aov depth").code, 0);
  const Image bounces = read_exr(file("bounces.exr"));
  expect_sum(bounces, {"bounce0", "bounce1", "bounce2plus"}, "Y");
  EXPECT_NE(bounces.find("depth.Z"), nullptr);
  for (std::size_t pixel = 0; pixel < lights.pixels(); ++pixel)
    EXPECT_EQ(value(lights, "Y", pixel), value(bounces, "Y", pixel));
}

TEST(Layers, ALightIsAskedForByTheNameThatTheSceneGivesIt) {
  ASSERT_EQ(run_render(coloured(), file("asked.exr"), "--layers 'lights:lamp 1'").code, 0);
  const Image film = read_exr(file("asked.exr"));
  expect_sum(film, {"light.lamp_1", "light.rest"}, "Y");
}

TEST(Layers, OfSpectralFilmsAreRadiances) {
  ASSERT_EQ(run_render(spectral(), file("bands.exr"), "--layers lights").code, 0);
  const Image film = read_exr(file("bands.exr"));
  for (const char* plane : {"S0.450,000000nm", "S0.650,000000nm", "R"})
    expect_sum(film, {"light.lamp_1", "light.sky"}, plane);
}

TEST(Layers, PartsMakeTheFileOfTheWhole) {
  const std::string layers = "--layers lights:sky ";
  std::string parts;
  for (const char* cut :
       {"--crop 0,0,7,16", "--crop 7,0,24,16 --sample-range 3:8", "--crop 7,0,24,16 --sample-range 0:3"}) {
    const std::string part = fmt::format("layers{}.abbepart", parts.size());
    ASSERT_EQ(run_render(coloured(), file(part), layers + cut).code, 0);
    parts += file(part) + " ";
  }
  ASSERT_EQ(run_render(coloured(), file("whole.exr"), layers).code, 0);
  ASSERT_EQ(abbe(fmt::format("merge {} -o {}", parts, file("sum.exr"))).code, 0);
  EXPECT_EQ(read_file(file("sum.exr")), read_file(file("whole.exr")));
}

// The film is as bright as a render with a dimmer lamp, without additional noise, since both have the same
// paths.
TEST(Layers, LightsAreTurnedDownWithoutRendering) {
  ASSERT_EQ(run_render(coloured(), file("lit.exr"), "--layers lights").code, 0);
  const Image lit = read_exr(file("lit.exr"));
  const Outcome run = abbe(fmt::format("develop {} --light lamp_1=0.25,0.5,1 --light sky=2 -o {}",
                                       file("lit.exr"), file("anew.exr")));
  ASSERT_EQ(run.code, 0) << run.err;
  const std::vector<ExrPart> parts = read_exr_parts(file("anew.exr"));
  const Image& anew = parts.front().image;
  const std::size_t pixel = 8 * 24 + 12;
  for (const auto& [plane, factor] : {std::pair("X", 0.25F), std::pair("Y", 0.5F), std::pair("Z", 1.0F)}) {
    const std::string of = std::string(".") + plane;
    const float expected =
        factor * value(lit, "light.lamp_1" + of, pixel) + 2 * value(lit, "light.sky" + of, pixel);
    EXPECT_NEAR(value(anew, plane, pixel), expected, 1e-5 * expected) << plane;
  }
  ASSERT_EQ(run_render(spectral(), file("dim.exr"), "--layers lights").code, 0);
  const Outcome seen =
      abbe(fmt::format("develop {} --light lamp_1=0 --display {}", file("dim.exr"), file("dim.png")));
  EXPECT_EQ(seen.code, 0) << seen.err;
}

TEST(Layers, WhatCannotBeToldIsRefused) {
  const auto fails = [](const Outcome& run, int code, const char* text) {
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_NE(run.err.find(text), std::string::npos) << run.err;
  };
  fails(run_render(coloured(), file("no.exr"), "--layers colours"), 2,
        "--layers: got \"colours\", allowed lights, lights:NAME,..., bounces or bounces:N");
  fails(run_render(coloured(), file("no.exr"), "--layers bounces:0"), 2,
        "--layers: got \"0\", allowed whole numbers in [1, 64]");
  fails(run_render(coloured(), file("no.exr"), "--layers lights:moon"), 2,
        "--layers: no light has this name (got \"moon\", allowed lamp_1, sky)");
  ASSERT_EQ(run_render(coloured(), file("plain.exr"), "").code, 0);
  fails(abbe(fmt::format("develop {} --light sky=2 -o {}", file("plain.exr"), file("no.exr"))), 2,
        "--light: the film has no layers of lights: render it with --layers lights");
  fails(abbe(fmt::format("develop {} --light sky -o {}", file("plain.exr"), file("no.exr"))), 2,
        "--light: got \"sky\", allowed NAME=FACTOR");
  fails(abbe(fmt::format("develop {} --light sky=0.5,-1 -o {}", file("plain.exr"), file("no.exr"))), 2,
        "--light: got -1, allowed [0, 1e+30]");
}

}  // namespace
}  // namespace abbe::test

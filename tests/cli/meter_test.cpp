#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "tests/cli/program.h"

namespace abbe::test {
namespace {

// A lamp of 100 lm at the centre of a white sphere, and three meters.
std::string hall() {
  return scratch()
      .write("hall.json", R"({
  "abbe": 1,
  "materials": {"wall": {"diffuse": {"reflectance": 0.5}}},
  "lights": [{"point": {"at": [0, 0, 0]}, "emission": {"illuminant": "E", "luminous_flux_lm": 100}}],
  "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 2}, "material": "wall"}],
  "meters": {
    "wall": {"at": [0, 0, -1.9999], "normal": [0, 0, 1]},
    "bulb": {"measures": "flux", "sphere": {"center": [0, 0, 0], "radius": 0.1, "facing": "inwards"},
             "spectrum": {"from_nm": 400, "to_nm": 700, "step_nm": 50}},
    "table": {"quad": {"corner": [-0.5, -0.5, -1], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]}, "cells": [4, 2]}
  },
  "render": {"samples": 16}
})")
      .string();
}

TEST(MeterCommand, TellsEachMeterWithItsUncertainty) {
  const Outcome run = abbe("meter " + hall() + " --json --quiet --integrator path");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto meters = run.json()["meters"];
  ASSERT_EQ(meters.size(), 3U);
  const auto& wall = meters[0];
  EXPECT_EQ(wall["name"], "wall");
  EXPECT_EQ(wall["measures"], "irradiance");
  EXPECT_EQ(wall["luminous"]["unit"], "lx");
  const double half = wall["luminous"]["half_interval_95"].get<double>();
  // The illuminance at the wall of an integrating sphere is Phi / (4 pi r^2 (1 - rho)).
  EXPECT_NEAR(wall["luminous"]["value"].get<double>(), 100 / (16 * std::numbers::pi) / 0.5, 3 * half);
  EXPECT_GT(half, 1.9 * wall["luminous"]["standard_error"].get<double>());
  EXPECT_EQ(meters[1]["spectrum"]["wavelength_nm"], nlohmann::json({425, 475, 525, 575, 625, 675}));
  EXPECT_EQ(meters[2]["cells"]["columns"], 4);
  EXPECT_EQ(meters[2]["cells"]["luminous"].size(), 8U);
}

TEST(MeterCommand, ReadsThoseThatAreNamed) {
  const Outcome run = abbe("meter " + hall() + " --only bulb --quiet");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out.rfind("bulb  flux  ", 0), 0U) << run.out;
  EXPECT_EQ(run.out.find("wall"), std::string::npos);
  const Outcome unknown = abbe("meter " + hall() + " --only lamp");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("--only: no such meter (got \"lamp\", allowed wall, bulb, table)"),
            std::string::npos)
      << unknown.err;
}

TEST(MeterCommand, WritesSpectra) {
  const std::string table = (scratch() / "spectra.csv").string();
  const Outcome run = abbe("meter " + hall() + " --quiet --spectra " + table);
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string text = read_file(table);
  EXPECT_EQ(text.rfind("meter,from_nm,to_nm,per_nm,standard_error,unit\nbulb,400,450,", 0), 0U) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 7);
  EXPECT_EQ(abbe("meter " + hall() + " --only wall --spectra " + table).code, 2) << "it has none";
}

TEST(MeterCommand, StopsAtTheErrorAskedFor) {
  const Outcome run = abbe("meter " + hall() + " --only wall --error 0.3% --json --quiet");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto meter = run.json()["meters"][0];
  for (const char* figure : {"radiant", "luminous", "photons"})
    EXPECT_LE(meter[figure]["standard_error"].get<double>(), 0.003 * meter[figure]["value"].get<double>());
}

TEST(MeterCommand, OverwritesNothingThatTheSceneReads) {
  const auto lamp =
      scratch().write("lamp.csv", "# unit: relative\n# outside: zero\nwavelength_nm,L\n400,1\n700,1\n");
  const auto scene = scratch().write("lit.json", R"({"abbe": 1,
    "lights": [{"point": {"at": [0, 0, 1]}, "emission": {"illuminant": "lamp.csv:L", "luminous_flux_lm": 9}}],
    "meters": {"m": {"at": [0, 0, 0], "normal": [0, 0, 1], "spectrum": {"from_nm": 400, "to_nm": 700, "step_nm": 100}}}})");
  const std::string before = read_file(lamp);
  const Outcome run = abbe("meter " + scene.string() + " --quiet --spectra " + lamp.string());
  EXPECT_EQ(run.code, 2) << run.err;
  EXPECT_EQ(read_file(lamp), before);
  EXPECT_EQ(abbe("meter " + scene.string() + " --spectra /nonexistent/x.csv").code, 5);
}

// Each cell receives a part of a flux. The uniformity is that of the parts.
TEST(MeterCommand, TellsUniformityOfCells) {
  const auto scene = scratch().write("even.json", R"({"abbe": 1,
    "lights": [{"directional": {"towards": [0, 0, 1], "irradiance": 3}}],
    "meters": {"m": {"measures": "flux", "cells": [2, 2],
                     "quad": {"corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]}}}})");
  const Outcome run = abbe("meter " + scene.string() + " --quiet");
  ASSERT_EQ(run.code, 0) << run.err;
  const std::size_t at = run.out.find(", minimum / mean ");
  ASSERT_NE(at, std::string::npos) << run.out;
  EXPECT_GT(std::stod(run.out.substr(at + 17)), 0.95) << run.out;
}

TEST(MeterCommand, TellsOfADarkPlaceAndStrictlyRefusesIt) {
  const auto scene = scratch().write("dark.json", R"({"abbe": 1,
    "lights": [{"directional": {"towards": [0, 0, 1], "irradiance": 3}}],
    "materials": {"steel": {"diffuse": {"reflectance": 0.5}}},
    "shapes": [{"name": "safe", "sphere": {"center": [0, 0, 0], "radius": 1}, "material": "steel"}],
    "meters": {"inside": {"at": [0, 0, 0], "normal": [0, 0, 1]}}})");
  const Outcome run = abbe("meter " + scene.string() + " --quiet --error 1%");
  EXPECT_EQ(run.code, 0);
  EXPECT_NE(run.err.find("warning: meter inside: the camera is inside \"safe\""), std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("warning: meter inside: a pilot found no light at the meter: --error has no effect"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(run.err.find("no light reached the sensor"), std::string::npos) << "it is told why";
  const Outcome strict = abbe("meter " + scene.string() + " --quiet --strict");
  EXPECT_EQ(strict.code, 3);
  EXPECT_NE(strict.err.find("inside: the camera is inside"), std::string::npos) << strict.err;
}

// Under a square ceiling with half side a, the centre of the floor at a distance d below has E = 4 L A atan A
// with A = a / sqrt(a^2 + d^2).
TEST(MeterCommand, TellsOfALampOnACeilingAndMeasuresOneThatIsApart) {
  const auto read = [](double height) {
    return abbe("meter --quiet --strict --json " + scratch()
                                                       .write("ceiling.json", fmt::format(R"({{"abbe": 1,
    "materials": {{"black": {{"diffuse": {{"reflectance": 0}}}}}},
    "shapes": [{{"quad": {{"corner": [-2, -2, 0.5], "edge_u": [0, 4, 0], "edge_v": [4, 0, 0]}}, "material": "black"}}],
    "lights": [{{"quad": {{"corner": [-1, -1, {}], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0]}},
                 "emission": {{"illuminant": "A", "luminance": 1000}}}}],
    "meters": {{"floor": {{"at": [0, 0, 0], "normal": [0, 0, 1]}}}}}})",
                                                                                          height))
                                                       .string());
  };
  const Outcome flush = read(0.5);
  EXPECT_EQ(flush.code, 3);
  EXPECT_NE(flush.err.find("\"shape 0\" and \"light 0\" coincide"), std::string::npos) << flush.err;
  const Outcome apart = read(0.499);
  ASSERT_EQ(apart.code, 0) << apart.err;
  const auto luminous = apart.json()["meters"][0]["luminous"];
  const double share = 1 / std::hypot(1, 0.499);
  EXPECT_NEAR(luminous["value"].get<double>(), 4000 * share * std::atan(share),
              3 * luminous["half_interval_95"].get<double>());
  EXPECT_LT(luminous["half_interval_95"].get<double>(), 10);
}

TEST(MeterCommand, TellsOnceForAllMetersWhatLampsLieOn) {
  const auto scene = scratch().write("meters_under_ceiling.json", R"({"abbe": 1,
    "materials": {"black": {"diffuse": {"reflectance": 0}}},
    "shapes": [{"quad": {"corner": [-2, -2, 0.5], "edge_u": [0, 4, 0], "edge_v": [4, 0, 0]}, "material": "black"}],
    "lights": [{"quad": {"corner": [-1, -1, 0.5], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0]},
                "emission": {"illuminant": "A", "luminance": 1000}}],
    "meters": {"floor": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "step": {"at": [0, 0, 0.2], "normal": [0, 0, 1]}}})");
  const Outcome run = abbe("meter --quiet --spp 1 " + scene.string());
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(
      run.err,
      "abbe: warning: \"shape 0\" and \"light 0\" coincide within single precision: rays hit only one of "
      "the two surfaces, so that the other has no effect or its light is lost; separate them\n");
}

TEST(MeterCommand, TellsWhichMetersFoundNoLight) {
  const auto scene = scratch().write("below.json", R"({"abbe": 1,
    "lights": [{"directional": {"towards": [0, 0, 1], "irradiance": 3}}],
    "meters": {"up": {"at": [0, 0, 0], "normal": [0, 0, 1]}, "down": {"at": [0, 0, 0], "normal": [0, 0, -1]}}})");
  const Outcome run = abbe("meter " + scene.string() + " --quiet --spp 16");
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err.find("meter up"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("warning: meter down: no light reached the sensor in 16 samples per pixel, although "
                         "lights emit in its wavelength range"),
            std::string::npos)
      << run.err;
}

TEST(MeterCommand, NeedsMetersAndNoCamera) {
  const Outcome picture = abbe("render " + hall());
  EXPECT_EQ(picture.code, 3);
  EXPECT_NE(picture.err.find("meters but no camera"), std::string::npos) << picture.err;
  const Outcome none = abbe("meter " + scratch().write("none.json", R"({"abbe": 1, "meters": {}})").string());
  EXPECT_EQ(none.code, 3);
  EXPECT_NE(none.err.find("the scene has no meters"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace abbe::test

// Warnings of light that is missing from an image, and silence otherwise.
#include <algorithm>
#include <string_view>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "tests/cli/runs.h"

namespace abbe::test {
namespace {

// A lamp with a shape illuminates the scene outside the shell. One more ball may be present.
std::string room(const std::string& shapes, const std::string& lights) {
  return scratch()
      .write(
          "room.json",
          R"({"abbe": 1, "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
  "sensor": {"resolution": [4, 4], "observer": "1931"}, "render": {"samples": 1},
  "materials": {"white": {"diffuse": {"reflectance": 0.8}}, "glass": {"dielectric": {"ior": 1.5}}, "mirror": {"mirror": {"reflectance": 1}}},
  "lights": [)" +
              lights + R"(], "shapes": [)" + shapes + "]}")
      .string();
}
const std::string kLamp =
    R"({"name": "lamp", "sphere": {"center": [0, -1, 2], "radius": 0.2}, "emission": {"illuminant": "A", "luminance": 100}})";
const std::string kBulb =
    R"({"name": "bulb", "point": {"at": [0, -1, 2]}, "emission": {"illuminant": "A", "luminous_flux_lm": 100}})";
std::string ball_of(const char* material, const char* radius = "0.5") {
  return fmt::format(
      R"({{"name": "ball", "sphere": {{"center": [0, 0, 0], "radius": {}}}, "material": "{}"}})", radius,
      material);
}
Outcome warned(const std::string& scene, const std::string& options = "") {
  return run_render(scene, file("warned.exr"), options);
}

TEST(Warnings, LightThatAChosenTechniqueLosesIsNamed) {
  const std::string scene = room(ball_of("white"), kLamp);
  EXPECT_EQ(warned(scene).err, "");
  const Outcome light = warned(scene, " --integrator light --spp 64");
  EXPECT_EQ(light.code, 0);
  EXPECT_EQ(light.err,
            "abbe: warning: integrator \"light\" cannot sample some light paths, whose light is missing: "
            "E L: lights seen directly (\"lamp\")\n");
  const Outcome strict = warned(scene, " --integrator light --strict");
  EXPECT_EQ(strict.code, 3);
  EXPECT_NE(strict.err.find("integrator \"light\" cannot sample"), std::string::npos) << strict.err;
}

// Otherwise the user would believe that a permitted method is used.
TEST(Warnings, WhatChoosesNothingIsRefused) {
  const std::string scene = room(ball_of("white"), kLamp);
  EXPECT_EQ(warned(scene, " --integrator auto --consistent").code, 0);
  for (const char* chosen : {" --integrator path", " --set /render/integrator=path"}) {
    const Outcome run = warned(scene, std::string(" --consistent") + chosen);
    EXPECT_EQ(run.code, 2) << chosen;
    EXPECT_NE(run.err.find("--consistent: applies to the integrator auto only"), std::string::npos)
        << run.err;
  }
  const Outcome run =
      warned(scene, " --set /render/integrator=path --set /render/lights=light --integrator bdpt");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(
      run.err.find(
          "--integrator: the sampling settings of the scene apply to path only (got bdpt, allowed path)"),
      std::string::npos)
      << run.err;
  const Outcome allowed = warned(scene, " --set /render/consistent=true --integrator bdpt");
  EXPECT_EQ(allowed.code, 2);
  EXPECT_NE(allowed.err.find(
                "--integrator: render/consistent of the scene applies to auto only (got bdpt, allowed auto)"),
            std::string::npos)
      << allowed.err;
}

TEST(Warnings, SettingsOfPhotonsThatTheIntegratorMakesNoUseOfAreNamed) {
  const std::string scene = room(ball_of("white"), kLamp);
  const auto unused = [&](const std::string& options, const char* settings) {
    std::string set;
    for (std::string_view all = settings; !all.empty();) {
      const std::size_t end = std::min(all.find(' '), all.size());
      set += " --set /render/photons/" + std::string(all.substr(0, end));
      all.remove_prefix(std::min(end + 1, all.size()));
    }
    const Outcome run = warned(scene + set, options);
    EXPECT_EQ(run.code, 0) << run.err;
    const std::string before = "does not use these settings: ";
    const std::size_t at = run.err.find(before);
    if (at == std::string::npos) return std::string();
    return run.err.substr(at + before.size(), run.err.find('\n', at) - at - before.size());
  };
  const char* kAll = "per_sample=100 radius=0.1 nearest=7 final_gather=true";
  const std::string of_map = "render/photons/nearest, render/photons/final_gather";
  for (const char* integrator : {"auto", "path", "light", "bdpt"})
    EXPECT_EQ(unused(std::string("--integrator ") + integrator, kAll),
              "render/photons/per_sample, render/photons/radius, " + of_map)
        << integrator;
  EXPECT_EQ(unused("--integrator vcm", kAll), "render/photons/per_sample, " + of_map);
  EXPECT_EQ(unused("--consistent", kAll), "render/photons/per_sample, " + of_map);
  for (const char* integrator : {"ppm", "sppm"})
    EXPECT_EQ(unused(std::string("--integrator ") + integrator, kAll), of_map) << integrator;
  EXPECT_EQ(unused("--integrator photon-map", kAll), "render/photons/radius");
  EXPECT_EQ(unused("--integrator path", "nearest=50"), "") << "is so anyway";
}

// A black film does not show light that its samples missed.
TEST(Warnings, ABlackFilmIsTold) {
  const std::string said =
      "abbe: warning: no light reached the sensor in 1 samples per pixel, although lights emit in its "
      "wavelength range: nothing can reach it, or the paths are too rare; check a ray with `abbe trace`, or "
      "increase --spp\n";
  const std::string nothing_there = room("", kBulb);
  EXPECT_EQ(warned(nothing_there).err, said);
  EXPECT_EQ(warned(nothing_there, "--strict").code, 0) << "it may be right";
  EXPECT_EQ(warned(nothing_there + " --set /sensor/stokes=true").err, said);
  EXPECT_EQ(warned(nothing_there, "--crop 0,0,2,2").err, "") << "may be of what is black";
  const std::string infrared =
      R"({"point": {"at": [0, -1, 2]}, "emission": {"spectrum": {"band": [900, 1000], "value": 1}}})";
  for (const std::string& lights : {std::string(), infrared}) {
    const Outcome run = warned(room(ball_of("white"), lights));
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.err.find("no light reached the sensor"), std::string::npos) << run.err;
  }
}

TEST(Warnings, LightThatNoTechniqueReachesIsRepeated) {
  const std::string scene = room(ball_of("glass") + ", " + ball_of("white", "0.1"), kBulb);
  const Outcome run = warned(scene, " --strict");
  EXPECT_EQ(run.code, 0);
  EXPECT_NE(run.err.find("warning: no integrator can sample some light paths"), std::string::npos) << run.err;
  EXPECT_NE(
      run.err.find("E S+ L: a point, spot or directional light seen in mirrors or through glass (\"bulb\")"),
      std::string::npos)
      << run.err;
}

TEST(Warnings, StrictRefusesASceneThatIsDark) {
  const std::string unlit = room(ball_of("white"), "");
  EXPECT_EQ(warned(unlit).code, 0);
  const Outcome strict = warned(unlit, " --strict");
  EXPECT_EQ(strict.code, 3);
  EXPECT_NE(strict.err.find("error: no light: the image will be black"), std::string::npos) << strict.err;
  for (const char* power : {"0", "100"}) {
    const std::string lamp =
        fmt::format(R"({{"name": "bulb", "point": {{"at": [0, -1, 2]}}, "emission": {{"illuminant": "A", )"
                    R"("luminous_flux_lm": {}}}}})",
                    power);
    const Outcome run = warned(room(ball_of("white"), kLamp + ", " + lamp), " --strict");
    EXPECT_EQ(run.code, *power == '0' ? 3 : 0) << run.err;
    EXPECT_EQ(run.err.find("error: \"bulb\" emits nothing") != std::string::npos, *power == '0') << run.err;
  }
}

// Commands that explain a scene answer even if no render is possible.
TEST(Warnings, InfoAnswersWherePhotonsCannotBeTraced) {
  std::string text = read_file(
      room(R"({"name": "ground", "sphere": {"center": [0, 0, -7e6], "radius": 6e6}, "material": "glass"}, )" +
               ball_of("white"),
           R"({"name": "sun", "sun": {"towards": [0, 0, 1], "irradiance": 1}}, )" + kLamp));
  const std::string samples = R"("samples": 1)";
  text.replace(text.find(samples), samples.size(), R"("integrator": "light")");
  const std::string scene = scratch().write("afar.json", text).string();
  EXPECT_EQ(warned(scene).code, 3);
  for (const char* as : {"", " --json"}) {
    const Outcome run = abbe("info " + scene + as);
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.err.find("warning: ground: photons of a distant light cannot illuminate"),
              std::string::npos)
        << run.err;
    EXPECT_NE(run.out.find("light"), std::string::npos);
    EXPECT_EQ(run.out.find("wavelength"), std::string::npos) << "nobody drew any";
  }
}

TEST(Warnings, PolarisationLeftOutTakesALineUnlessQuiet) {
  const std::string scene = room(ball_of("glass"), kLamp);
  const std::string left_out = scene + " --set /render/polarisation=off";
  EXPECT_EQ(abbe("info " + scene).err.find("polarisation"), std::string::npos);
  EXPECT_EQ(warned(left_out).err.find("polarisation"), std::string::npos);
  const Outcome loud = abbe("render " + left_out + " -o " + (scratch() / "warned.exr").string());
  const std::size_t at =
      loud.err.find("abbe: render/polarisation is \"off\", which affects the image after shape \"ball\"");
  ASSERT_NE(at, std::string::npos) << loud.err;
  EXPECT_LT(loud.err.find('\n', at) - at, 220U);
  const Outcome measuring = warned(left_out + " --set /sensor/stokes=true");
  EXPECT_NE(measuring.err.find("warning: the sensor measures polarisation"), std::string::npos)
      << measuring.err;
  EXPECT_EQ(warned(left_out + " --set /sensor/stokes=true", " --strict").code, 3);
  const std::string mirrors = room(ball_of("mirror") + ", " + ball_of("mirror", "0.1"), kLamp);
  EXPECT_EQ(warned(mirrors + " --set /render/polarisation=off", "--spp 256").err, "");
}

TEST(Warnings, ACameraWithinOpaqueMatterIsTold) {
  const std::string inside =
      room(ball_of("white", "5"), R"({"name": "sky", "environment": {}, "emission": {"spectrum": 1}})");
  const std::string said =
      "abbe: warning: the camera is inside \"ball\", which is opaque and contains no light\n";
  EXPECT_EQ(warned(inside).err, said);
  EXPECT_EQ(abbe("info " + inside).err, said);
  EXPECT_EQ(warned(inside, " --strict").code, 3);
  EXPECT_EQ(warned(room(ball_of("white", "5"), kLamp)).err, "");
}

TEST(Warnings, GlassWithoutThicknessAndMetersOnLightsAreReported) {
  const std::string coated = room(ball_of("white") + ", " + ball_of("glass"), kLamp);
  const std::string lost =
      "\"ball\" and \"ball\" coincide within single precision: rays hit only one of the two surfaces, so "
      "that "
      "the other has no effect or its light is lost; separate them";
  EXPECT_NE(abbe("info " + coated).err.find("abbe: warning: " + lost + "\n"), std::string::npos);
  EXPECT_EQ(warned(coated, " --strict").code, 3);
  const std::string metered = scratch()
                                  .write("meter_on_light.json", R"({"abbe": 1,
    "camera": {"irradiance_probe": {"at": [1, 0, 0], "normal": [-1, 0, 0]}},
    "sensor": {"resolution": [1, 1], "observer": "1931"},
    "lights": [{"name": "bulb", "sphere": {"center": [0, 0, 0], "radius": 1}, "emission": {"spectrum": 1}}]})")
                                  .string();
  const std::string said =
      "the meter coincides within rounding with \"bulb\" and does not receive its emission: separate them";
  EXPECT_NE(abbe("info " + metered).err.find("abbe: warning: " + said + "\n"), std::string::npos);
  EXPECT_NE(warned(metered).err.find("warning: " + said), std::string::npos);
}

TEST(Warnings, ALampOnSomethingOpaqueIsTold) {
  const auto lit_by = [](const std::string& lamp) {
    return room(
        ball_of("white") +
            R"(, {"name": "ceiling", "quad": {"corner": [-4, -4, 2], "edge_u": [0, 8, 0], "edge_v": [8, 0, 0]}, "material": "white"})",
        lamp + R"(, "emission": {"illuminant": "A", "luminous_flux_lm": 100}})");
  };
  const auto panel_at = [](double z) {
    return fmt::format(
        R"({{"name": "panel", "quad": {{"corner": [-1, -1, {}], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0]}})",
        z);
  };
  const std::string flush = lit_by(panel_at(2));
  const std::string said =
      "\"ceiling\" and \"panel\" coincide within single precision: rays hit only one of the two surfaces, so "
      "that the other has no effect or its light is lost; separate them";
  EXPECT_EQ(abbe("info " + flush).err, "abbe: warning: " + said + "\n");
  EXPECT_NE(warned(flush).err.find("warning: " + said), std::string::npos);
  const Outcome strict = warned(flush, " --strict");
  EXPECT_EQ(strict.code, 3);
  EXPECT_NE(strict.err.find(said), std::string::npos) << strict.err;
  EXPECT_EQ(abbe("info " + lit_by(panel_at(1.999))).err, "");
  EXPECT_EQ(warned(lit_by(panel_at(1.999)), " --strict").code, 0);
}

}  // namespace
}  // namespace abbe::test

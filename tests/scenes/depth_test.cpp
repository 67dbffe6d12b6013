// How long paths are: as long as it takes, unless the scene says otherwise.
#include <numbers>

#include <fmt/format.h>

#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/path/roulette.h"

namespace abbe {
namespace {

// A cubic room of side 4 m, reflectance 0.99 and a lamp of 10 000 lm: E = Phi/96/(1 - rho) in the mean of a
// wall, of which the first 64 events make 48 %.
TEST(Depth, AWhiteRoomIsAsBrightAsItsWallsMakeIt) {
  const Scene scene =
      test::load("validation/room.json", {{"/materials/wall/diffuse/reflectance", "0.99"},
                                          {"/sensor/resolution", "[8, 8]"},
                                          {"/render/samples", test::nightly() ? "1024" : "512"}});
  const RenderResult result = render(scene, {});
  const Film::Average lux = result.film.average(1);
  fmt::print("{:.0f} +- {:.0f} lx\n", lux.mean, lux.standard_error);
  EXPECT_NEAR(lux.mean, 10000.0 / 96 / 0.01, 0.05 * 10416.67);
  EXPECT_NEAR(lux.mean, 10000.0 / 96 / 0.01, 4.9 * lux.standard_error);
  EXPECT_EQ(result.stats.cut.paths, 0U);
}

TEST(Depth, AnExplicitOneIsHonouredAndSaysWhatItCutsOff) {
  Scene scene = test::load("validation/furnace.json", {{"/sensor/resolution", "[4, 4]"},
                                                       {"/render", R"({"samples": 1024, "max_depth": 3})"}});
  const RenderResult cut = render(scene, {});
  EXPECT_NEAR(cut.film.average(1).mean, std::numbers::pi * (1 - std::pow(0.8, 4)), 0.01);
  const auto paths = static_cast<double>(cut.stats.paths);
  // Each path has three of the walls' events behind it and 0.8^3 of its throughput left.
  EXPECT_EQ(cut.stats.cut.paths, cut.stats.paths);
  EXPECT_NEAR(cut.stats.cut.throughput() / paths, std::pow(0.8, 3), 1e-5);
}

// Camera and lamp within a ball that loses nothing, and perhaps more.
std::string lossless(const char* integrator, const char* more) {
  return fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 40}}, "from": [0, 0.3, 0], "to": [0.2, 0, 1], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [2, 2], "response": "energy", "channels": {{"all": 1}}}},
    "materials": {{"wall": {{"mirror": {{"reflectance": 1}}}}, "card": {{"diffuse": {{"reflectance": 1}}}}}},
    "lights": [{{"point": {{"at": [0, -0.2, 0]}}, "emission": {{"spectrum": 1}}}}],
    "shapes": [{{"sphere": {{"center": [0, 0, 0], "radius": 1}}, "material": "wall"}}{}],
    "render": {{"integrator": "{}", "samples": 8}}}})",
                     more, integrator);
}

TEST(Depth, PathsEndWhereNothingIsAbsorbed) {
  const char* card = R"(, {"sphere": {"center": [0.5, 0, 0], "radius": 0.1}, "material": "card"})";
  for (const char* integrator : {"path", "light"}) {
    const RenderResult result =
        render(test::load_text(lossless(integrator, card), {{"/render/samples", "512"}}), {});
    // After n events 64/n are left of those that only mirrors turned, and the root of that of the others.
    EXPECT_LT(100 * result.stats.cut.paths, result.stats.paths) << integrator;
    EXPECT_LT(result.stats.rays, 2000 * result.stats.paths) << integrator;
    EXPECT_GT(result.stats.rays, 64 * result.stats.paths) << integrator;
    EXPECT_EQ(result.stats.nonfinite_samples, 0U) << integrator;
  }
}

TEST(Depth, ThereIsACapThatCounts) {
  for (const char* integrator : {"path", "light"}) {
    Scene scene = test::load_text(lossless(integrator, ""));
    scene.render.roulette_depth = -1;
    scene.render.samples = 1;
    const RenderResult one = render(scene, {.threads = 1});
    EXPECT_EQ(one.stats.cut.paths, one.stats.paths) << integrator;
    EXPECT_NEAR(one.stats.cut.throughput(), static_cast<double>(one.stats.paths), 1e-3) << integrator;
    EXPECT_GE(one.stats.rays, one.stats.paths * static_cast<std::uint64_t>(kMaxPathDepth)) << integrator;
    EXPECT_EQ(render(scene, {.threads = 2}).stats.cut.paths, one.stats.cut.paths);
  }
}

// What is cut has another event before it: a path that leaves the scene after as many as it may have does
// not, whichever end it sets out from.
TEST(Depth, WhatLeavesTheSceneIsNotCut) {
  for (const char* integrator : {"path", "light"})
    for (const bool under_a_roof : {false, true}) {
      const std::string roof =
          R"(, {"quad": {"corner": [-1000, -1000, 9], "edge_u": [0, 2000, 0], "edge_v": [2000, 0, 0]}, "material": "card"})";
      const Scene scene = test::load_text(fmt::format(
          R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 20}}, "from": [0, 0, 3], "to": [0, 0, 0], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [8, 8], "response": "energy", "channels": {{"all": 1}}}},
    "materials": {{"card": {{"diffuse": {{"reflectance": 0.5}}}}}},
    "lights": [{{"point": {{"at": [0, 0, 2]}}, "emission": {{"spectrum": 1}}}}],
    "shapes": [{{"quad": {{"corner": [-9, -9, 0], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]}}, "material": "card"}}{}],
    "render": {{"integrator": "{}", "samples": 4, "max_depth": 1}}}})",
          under_a_roof ? roof : "", integrator));
      const RenderStats stats = render(scene, {}).stats;
      EXPECT_EQ(stats.cut.paths > 0, under_a_roof) << integrator;
      EXPECT_EQ(stats.cut.throughput(), static_cast<double>(stats.cut.paths) / 2) << integrator;
    }
}

TEST(Depth, WhatIsCutDependsOnNoThreads) {
  const Scene scene = test::load("validation/furnace.json",
                                 {{"/sensor/resolution", "[64, 64]"},
                                  {"/materials/wall/diffuse/reflectance", R"({"band": [400, 650]})"},
                                  {"/render", R"({"samples": 16, "max_depth": 6, "integrator": "light"})"}});
  const TruncatedPaths one = render(scene, {.threads = 1}).stats.cut;
  EXPECT_GT(one.throughput(), 0);
  for (int trial = 0; trial < 4; ++trial) {
    const TruncatedPaths four = render(scene, {.threads = 4}).stats.cut;
    EXPECT_EQ(four.paths, one.paths);
    EXPECT_EQ(four.throughput(), one.throughput());
  }
}

// Photons that set out at none of the wavelengths of their lamp carry nothing that could be cut.
TEST(Depth, PhotonsWithoutPowerAreNotCut) {
  std::string lamps;
  for (int nm = 400; nm < 700; nm += 10)
    lamps += fmt::format(
        R"({}{{"point": {{"at": [0, 0.1, 0]}}, "emission": {{"lines": [{{"nm": {}, "width_nm": 0.1, "power": 1}}], "intensity": 1}}}})",
        lamps.empty() ? "" : ", ", nm);
  const Scene scene = test::load_text(fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 40}}, "from": [0, 0, -0.5], "to": [0, 0, 0], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [8, 8], "response": "energy", "channels": {{"all": 1}}}},
    "materials": {{"fog": {{"medium": {{"scattering_per_m": 1000}}}}}},
    "lights": [{}],
    "shapes": [{{"sphere": {{"center": [0, 0, 0], "radius": 1}}, "material": "fog"}}],
    "render": {{"integrator": "light", "samples": 16, "max_depth": 2}}}})",
                                                  lamps));
  const RenderStats stats = render(scene, {}).stats;
  EXPECT_GT(stats.cut.paths, 0U);
  EXPECT_LT(stats.cut.paths, stats.paths) << "every photon has its lamp's line";
  EXPECT_GT(stats.cut.throughput(), 0);
  EXPECT_LE(stats.cut.throughput(), 1.01 * static_cast<double>(stats.cut.paths));
}

// Lobes of a caustic point where the hero of some paths would not be scattered to at all, only other lanes.
TEST(Depth, WhatIsCutIsOfTheOrderOfItsPathsWhereACausticIsLookedFor) {
  const Scene scene = test::load_text(R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -3, 2], "to": [0, 0, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [32, 32], "observer": "1931"},
    "materials": {"white": {"diffuse": {"reflectance": 0.5}}, "glass": {"dielectric": {"ior": 1.5}},
      "mirror": {"mirror": {"reflectance": 0.9}},
      "floor": {"mixture": [{"material": "mirror", "weight": {"band": [550, 700]}},
                            {"material": "white", "weight": {"band": [400, 549]}}]}},
    "lights": [{"name": "lamp", "sphere": {"center": [0, 0, 2], "radius": 0.2},
                "emission": {"spectrum": 1, "radiance": 100}}],
    "shapes": [{"quad": {"corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]}, "material": "floor"},
               {"quad": {"corner": [-2, 2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 0, 4]}, "material": "white"},
               {"quad": {"corner": [-2, -2, 0], "edge_u": [0, 4, 0], "edge_v": [0, 0, 4]}, "material": "white"},
               {"sphere": {"center": [0, 0, 0.6], "radius": 0.3}, "material": "glass"}],
    "render": {"integrator": "path", "samples": 64, "max_depth": 6}})");
  const TruncatedPaths cut = render(scene, {}).stats.cut;
  EXPECT_GT(cut.paths, 0U);
  EXPECT_LT(cut.throughput(), 10 * static_cast<double>(cut.paths));
}

// Between walls that keep half a path has three rays for sure, the third with a quarter, and from there on
// each next one by half a chance: four in all.
TEST(Depth, CameraPathsGoOnForSureWhileTheyCarryAQuarter) {
  const RenderResult result =
      render(test::load("furnace.json", {{"/materials/wall/diffuse/reflectance", "0.5"},
                                         {"/sensor/resolution", "[32, 32]"},
                                         {"/render/samples", "32"},
                                         {"/render/integrator", "path"},
                                         {"/render/lights", "bsdf"},
                                         {"/render/roulette_depth", "1"}}),
             {});
  EXPECT_NEAR(static_cast<double>(result.stats.rays) / static_cast<double>(result.stats.paths), 4, 0.05);
}

TEST(Depth, SurvivalIsTheThroughputAndNeverSureInLongPaths) {
  RenderSettings settings;
  EXPECT_FALSE(plays_roulette(settings, 3));
  EXPECT_TRUE(plays_roulette(settings, 4));
  for (const float a : {kPathRouletteExponent, kSpecularRouletteExponent, kJoinedRouletteExponent}) {
    EXPECT_EQ(survival(0.7F, 4, a), 0.7F);
    EXPECT_EQ(survival(0.01F, 4, a), 0.1F);
    EXPECT_EQ(survival(3, 64, a), 1);
    EXPECT_EQ(survival(0.7F, 65, a), 0.7F);
  }
  EXPECT_FLOAT_EQ(survival(3, 100, 0.5F), 0.995F);
  EXPECT_FLOAT_EQ(survival(3, 100, 2), 0.98F);
  EXPECT_FLOAT_EQ(survival(3, 1000, 1), 0.999F);
  EXPECT_EQ(depth_limit(settings), 100000);
  settings.max_depth = 12;
  settings.roulette_depth = -1;
  EXPECT_EQ(depth_limit(settings), 12);
  EXPECT_FALSE(plays_roulette(settings, 1000));
}

}  // namespace
}  // namespace abbe

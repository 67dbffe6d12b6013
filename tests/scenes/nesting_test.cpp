// Matter in matter: shapes of different indices within each other, overlapping, and touching.
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "materials/interface/fresnel.h"
#include "tests/scene/meshes.h"
#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "transport/path/ray_trace.h"

namespace abbe {
namespace {

using Imath::V3d;

std::string box(const std::string& material, double x0, double x1) {
  return fmt::format(R"({{"name": "{0}", "material": "{0}", "mesh": {1}}})", material,
                     test::inline_mesh(test::box({x0, -0.7, -0.5}, {x1, 0.6, 0.8})));
}
std::string ball(const std::string& material, double radius, const std::string& center = "0, 0, 0") {
  return fmt::format(R"({{"name": "{0}", "material": "{0}", "sphere": {{"center": [{2}], "radius": {1}}}}})",
                     material, radius, center);
}

constexpr const char* kNestedMatter = R"("materials": {
  "water": {"dielectric": {"ior": 1.333}}, "glass": {"dielectric": {"ior": 1.5}, "priority": 1},
  "flint": {"dielectric": {"ior": 1.7}}, "air": {"dielectric": {"ior": 1}},
  "ratio": {"dielectric": {"ior": 1.125281320330083}}, "bk7": {"dielectric": {"ior": "N-BK7"}, "priority": 1},
  "oil": {"dielectric": {"ior": "N-BK7"}}, "metal": {"conductor": {"ior": {"n": 0.2, "k": 3}}},
  "matched": {"conductor": {"ior": {"n": 1.7, "k": 0}}},
  "coated": {"conductor": {"ior": {"n": 0.2, "k": 3}, "coating": [{"ior": 1.6, "thickness_nm": 80}]}},
  "pane": {"thin_glass": {"ior": 1.5}}, "fog": {"medium": {"scattering_per_m": 1}},
  "clear": {"medium": {"absorption_per_m": 0}}, "clear first": {"medium": {"absorption_per_m": 0}, "priority": 3},
  "white": {"diffuse": {"reflectance": 0.7}}, "black": {"diffuse": {"reflectance": 0}}})";

// Shapes in light of radiance 1 from everywhere, unless there are `lights`.
Scene scene_of(const std::string& shapes,
               const std::string& settings = R"("max_depth": 1000, "roulette_depth": -1)",
               const std::string& lights = R"({"environment": {}, "emission": {"spectrum": 1}})",
               const std::string& from = "0.3, 0.2, -5") {
  return test::load_text(fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 30}}, "from": [{}], "to": [0, 0, 0], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [24, 24], "response": "energy", "channels": {{"all": {{"band": [450, 650]}}}}}},
    {}, "lights": [{}], "shapes": [{}], "render": {{"samples": 16, {}}}}})",
                                     from, kNestedMatter, lights, shapes, settings));
}

// The furthest any pixel is from what radiance `expected` exposes, relative.
double furthest(const Film& film, double expected = 1) {
  static const Film unit = render(scene_of(""), {}).film;
  double apart = 0;
  for (std::size_t pixel = 0; pixel < 24 * 24; ++pixel)
    apart = std::max(apart, std::abs(film.mean(pixel, 0) / unit.mean(pixel, 0) / expected - 1));
  return apart;
}

RayTrace traced(const Scene& scene, const V3d& origin, const V3d& towards) {
  return trace_ray(scene, {origin - scene.origin_m, (towards - origin).normalized()}, 550, 64);
}

// Each interface of a stack bends by the sine law of its two neighbours and reflects by their ratio.
TEST(Nesting, PlatesThatTouchObeySnellAndFresnel) {
  const Scene scene =
      scene_of(box("water", 0, 0.2) + "," + box("glass", 0.2, 0.3) + "," + box("flint", 0.3, 0.5));
  ASSERT_TRUE(scene.features.nesting);
  const RayTrace trace = traced(scene, {-1, -0.4, 0}, {0, 0.05, 0.02});
  ASSERT_EQ(trace.events.size(), 5U);
  const double n[] = {1, 1.333, 1.5, 1.7, 1};
  const double sine = std::sin(trace.events[0].passage->angle_in_deg * std::numbers::pi / 180);
  for (std::size_t i = 0; i < 4; ++i) {
    const Passage& passage = trace.events[i].passage.value();
    EXPECT_EQ(trace.events[i].kind, TraceEvent::Kind::refract);
    EXPECT_NEAR(passage.n_from, n[i], 1e-6);
    EXPECT_NEAR(passage.n_to, n[i + 1], 1e-6);
    EXPECT_NEAR(std::sin(passage.angle_out_deg * std::numbers::pi / 180), sine / n[i + 1], 1e-9);
    const auto f = fresnel_dielectric(std::sqrt(1 - sine * sine / n[i] / n[i]), n[i + 1] / n[i]);
    EXPECT_NEAR(passage.Rs, f.Rs, 1e-9);
    EXPECT_NEAR(passage.Rp, f.Rp, 1e-9);
  }
  EXPECT_NEAR(trace.last.direction.dot((V3d(0, 0.05, 0.02) - V3d(-1, -0.4, 0)).normalized()), 1, 1e-12);
}

TEST(Nesting, MetalInWaterReflectsByTheRatioOfIndices) {
  for (const char* metal : {"metal", "coated"}) {
    const Scene scene = scene_of(ball("water", 1) + "," + ball(metal, 0.5));
    const RayTrace trace = traced(scene, {-3, 0.1, 0.2}, {0, 0.1, 0.2});
    const Passage& passage = trace.events.at(1).passage.value();
    EXPECT_NEAR(passage.n_from, 1.333, 1e-6);
    const double c = std::cos(passage.angle_in_deg * std::numbers::pi / 180);
    const Coating& coating =
        std::get<ConductorMaterial>(scene.materials[scene.shapes[1].material].model).coating;
    // By a film seen from water: everything relative to it, the wavelength too.
    Coating seen = coating;
    for (Coating::Material& film : seen.materials) film.index = RefractiveIndex(1.6 / 1.333);
    const FresnelPower<double> f = coated_power(seen, 550 / 1.333, 0.2 / 1.333, 3 / 1.333, c, false);
    EXPECT_NEAR(passage.Rs, f.Rs, 1e-6) << metal;
    EXPECT_NEAR(passage.Rp, f.Rp, 1e-6) << metal;
    // The kernel's own.
    const SampledSpectrum lambda(550);
    const RefractiveIndex water(1.333);
    const Bsdf bsdf =
        make_bsdf(scene.materials[scene.shapes[1].material], {.wavelengths_nm = lambda, .outside = &water});
    const auto s = sample(bsdf, {static_cast<float>(std::sqrt(1 - c * c)), 0, static_cast<float>(c)},
                          {0.5F, {0, 0}}, 0, TransportMode::radiance);
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->weight[0], f.R(), 1e-6) << metal;
  }
}

// A plate of two quads of flint, and in it what has the same index: a ball of flint, which is not seen, and a
// metal without absorption, which takes all that comes to it.
TEST(Nesting, WhatStandsBetweenFacesOfMatterIsInIt) {
  constexpr double kIndex = 1.7;
  const std::string plate = R"(
    {"material": "flint", "quad": {"corner": [-9, -9, -1.2], "edge_u": [0, 18, 0], "edge_v": [18, 0, 0]}},
    {"material": "flint", "quad": {"corner": [-9, -9, 1.2], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]}})";
  const std::string metal =
      R"(, {"material": "matched", "disc": {"center": [0, 0, 0], "normal": [0, 0, -1], "radius": 5}})";
  // The means over the view of what the plate's first face reflects, and both let through.
  double reflected = 0;
  double transmitted = 0;
  constexpr int kSide = 50;
  const double edge = std::tan(15 * std::numbers::pi / 180);
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double x = edge * (i + 0.5) / kSide;
      const double y = edge * (j + 0.5) / kSide;
      const auto f = fresnel_dielectric(1 / std::sqrt(1 + x * x + y * y), kIndex);
      reflected += f.R() / kSide / kSide;
      transmitted += ((1 - f.Rs) / (1 + f.Rs) + (1 - f.Rp) / (1 + f.Rp)) / 2 / kSide / kSide;
    }
  const auto seen = [](const std::string& shapes, const std::string& lights) {
    const char* settings = R"("max_depth": 1000, "roulette_depth": -1, "integrator": "path")";
    Scene scene = scene_of(shapes, settings, lights);
    scene.render.samples = 256;
    static const Film unit = render(scene_of(""), {}).film;
    const Film film = render(scene, {}).film;
    return test::whole(film).mean / test::whole(unit).mean;
  };
  const std::string sky = R"({"environment": {}, "emission": {"spectrum": 1}})";
  const std::string behind =
      R"({"quad": {"corner": [-9, -9, 3], "edge_u": [0, 18, 0], "edge_v": [18, 0, 0]}, "emission": {"spectrum": 1}})";
  EXPECT_NEAR(seen(plate + metal, sky), reflected, 0.004);
  EXPECT_NEAR(seen(plate, behind), transmitted, 0.005);
  EXPECT_NEAR(seen(plate + "," + ball("flint", 1), behind), transmitted, 0.005);

  for (const std::string& inside : {metal, "," + ball("flint", 1)}) {
    const RayTrace trace = traced(scene_of(plate + inside), {0, 0, -3}, {0, 0, 0});
    EXPECT_NEAR(trace.events.at(0).R, std::pow((kIndex - 1) / (kIndex + 1), 2), 1e-6);
    EXPECT_NEAR(trace.events.at(1).R, 0, 1e-9) << inside;
  }
}

// Where shapes overlap, priority decides as if one had been carved out of the other.
TEST(Nesting, OverlapsAreCarvedByPriorityAndEqualThoseThatTouch) {
  const std::string glass = box("glass", -0.5, 0.2);
  const Scene touching = scene_of(glass + "," + box("water", 0.2, 0.9));
  std::vector<Scene> same;
  same.push_back(scene_of(box("water", 0.2, 0.9) + "," + glass));
  same.push_back(scene_of(glass + "," + box("water", -0.1, 0.9)));
  same.push_back(scene_of(glass + "," + box("water", 0.19999, 0.9)));
  same.push_back(scene_of(glass + "," + box("water", 0.2 - 1e-8, 0.9)));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.4, 0.5);
  for (int i = 0; i < 200; ++i) {
    const V3d from(i % 2 ? 3 : -3, 5 * uniform(random), 5 * uniform(random));
    const V3d to(uniform(random), uniform(random), uniform(random));
    const RayTrace expected = traced(touching, from, to);
    for (const Scene& scene : same) {
      const RayTrace trace = traced(scene, from, to);
      ASSERT_EQ(trace.events.size(), expected.events.size()) << i;
      EXPECT_NEAR((trace.last.direction - expected.last.direction).length(), 0, 1e-6) << i;
    }
  }
}

TEST(Nesting, NothingIsLostOrGainedInAFurnace) {
  const char* both = R"("max_depth": 1000, "roulette_depth": -1)";
  for (const std::string& shapes :
       {box("glass", -0.5, 0.2) + "," + box("water", 0.2, 0.9),
        box("glass", -0.5, 0.2) + "," + box("water", -0.1, 0.9), ball("water", 1) + "," + ball("flint", 0.5),
        ball("flint", 1) + "," + ball("air", 0.7, "0.2, 0, 0"),
        ball("glass", 0.8, "-0.3, 0, 0") + "," + ball("water", 0.8, "0.3, 0, 0"),
        ball("glass", 1) + "," + ball("flint", 1)}) {
    const RenderResult result = render(scene_of(shapes, both), {});
    EXPECT_LT(furthest(result.film), 2e-5) << shapes;
    EXPECT_EQ(result.stats.nonfinite_samples, 0U);
  }
}

std::string block(const std::string& material, const V3d& from, const V3d& to, double turned_deg = 0) {
  return fmt::format(
      R"({{"material": "{}", "transform": {{"rotate": {{"axis": [1, 2, 3], "deg": {}}}}}, "mesh": {}}})",
      material, turned_deg, test::inline_mesh(test::box(from, to)));
}

// Matter without an interface lies in glass and out of it, has a face in one of glass, or all around, and is
// there instead of the glass or not: light is refracted at the faces of the glass alone.
TEST(Nesting, AMediumHasTheIndexOfWhatItLiesIn) {
  for (const char* medium : {"clear", "clear first"})
    for (const std::string& shapes :
         {ball("flint", 1) + "," + ball(medium, 0.9, "0.5, 0.3, -0.4"),
          ball(medium, 1.1) + "," + ball("flint", 0.8, "0.5, 0.3, -0.4"),
          box("flint", -0.5, 0.2) + "," + box(medium, 0.2, 0.9),
          box(medium, -0.5, 0.5) + "," + box("flint", -0.2, 0.5), ball(medium, 2) + "," + ball("flint", 1)}) {
      const RenderResult result = render(scene_of(shapes), {});
      EXPECT_LT(furthest(result.film), 2e-5) << shapes;
      EXPECT_EQ(result.stats.cut.paths, 0U) << shapes;
    }
}

// A sheet on a face of glass is lost, one on a face of fog or in glass is not: with neither does light of the
// same radiance from everywhere change.
TEST(Nesting, ASheetOnMatterLeavesItsFaceThere) {
  const std::string sheet =
      R"({"material": "pane", "quad": {"corner": [0.2, -0.7, -0.5], "edge_u": [0, 1, 0], "edge_v": [0, 0, 1]}})";
  for (const std::string& matter : {box("flint", -0.5, 0.2), box("clear", -0.5, 0.2),
                                    box("flint", -0.5, 0.2) + "," + box("flint", 0.2, 0.9)})
    for (const std::string& shapes : {matter + "," + sheet, sheet + "," + matter}) {
      const RenderResult result = render(scene_of(shapes), {});
      EXPECT_LT(furthest(result.film), 2e-5) << shapes;
      EXPECT_EQ(result.stats.cut.paths, 0U) << shapes;
    }
}

// A block of glass on a black table is as bright from above as what its face reflects: nothing comes through
// the table, in whatever order both stand in the scene.
TEST(Nesting, GlassOnBlackIsBlackBehindItsReflection) {
  const std::string glass = block("flint", {-0.5, -0.5, 0}, {0.5, 0.5, 1});
  const std::string table =
      R"({"material": "black", "quad": {"corner": [-3, -3, 0], "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}})";
  const auto middle = [](const std::string& shapes) {
    Scene scene = scene_of(shapes, R"("max_depth": 1000)",
                           R"({"environment": {}, "emission": {"spectrum": 1}})", "0.3, -1, 4");
    scene.render.samples = 1024;
    return test::region(render(scene, {.crop = Crop{10, 10, 14, 14}}).film, 0, 10, 10, 14, 14).mean;
  };
  const double bare = middle("");
  const double face = fresnel_dielectric(4 / std::sqrt(0.3 * 0.3 + 1 + 4 * 4), 1.7).R();
  EXPECT_NEAR(middle(glass + "," + table) / bare, face, 0.15 * face);
  EXPECT_NEAR(middle(table + "," + glass) / bare, face, 0.15 * face);
  const std::string pane =
      R"({"material": "pane", "quad": {"corner": [-1, -1, 0], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0]}})";
  EXPECT_EQ(middle(pane + "," + table), 0) << "a sheet on a wall is lost";
  EXPECT_EQ(middle(table + "," + pane), 0);
}

// Matter flush with the walls of a closed room, in front of them or on both sides, lets nothing in.
TEST(Nesting, MatterFlushWithWallsLetsNoLightIn) {
  for (const double turned_deg : {0.0, 37.0}) {
    const std::string room = block("white", {-1, -1, -1}, {1, 1, 1}, turned_deg);
    for (const std::string& within : {block("flint", {0.8, -1, -1}, {1, 1, 1}, turned_deg),
                                      block("flint", {-1, 0.9, -1}, {1, 1.1, 1}, turned_deg),
                                      block("fog", {-1, -1, -1}, {1, 1, 1}, turned_deg)})
      for (const std::string& shapes : {room + "," + within, within + "," + room}) {
        const Film film =
            render(scene_of(shapes, R"("max_depth": 30)",
                            R"({"environment": {}, "emission": {"spectrum": 1e6}})", "0.5, 0.3, 0.2"),
                   {})
                .film;
        ASSERT_EQ(test::region(film, 0, 0, 0, 24, 24).mean, 0) << shapes;
      }
  }
}

// Seen from within, where floats do not tell a ball from the table that it touches, nor from another ball.
TEST(Nesting, ABallOfGlassShowsNothingBelowItsTable) {
  const std::string lamp =
      R"({"sphere": {"center": [0, 0, -40], "radius": 30}, "emission": {"spectrum": 1e6}})";
  const auto seen = [&](const std::string& below) {
    Scene scene =
        scene_of(ball("flint", 1, "0, 0, 1") + "," + below, R"("max_depth": 3)", lamp, "0.001, 0.002, 1");
    scene.render.samples = 512;
    return test::region(render(scene, {.crop = Crop{10, 10, 14, 14}}).film, 0, 10, 10, 14, 14).mean;
  };
  EXPECT_EQ(
      seen(
          R"({"material": "black", "quad": {"corner": [-50, -50, 0], "edge_u": [100, 0, 0], "edge_v": [0, 100, 0]}})"),
      0);
  EXPECT_EQ(
      seen(R"({"material": "black", "disc": {"center": [0, 0, 0], "normal": [0, 0, -1], "radius": 50}})"), 0);
  EXPECT_EQ(seen(ball("black", 30, "0, 0, -30")), 0);
  EXPECT_GT(seen(ball("black", 0.1, "1, 0, -0.5")), 0) << "the lamp is there";
}

// What is far, or large, leaves what is near as it is.
TEST(Nesting, FarThingsChangeNothingNear) {
  const char* settings = R"("max_depth": 1000, "roulette_depth": -1)";
  const std::string sky = R"({"environment": {}, "emission": {"spectrum": 1}})";
  std::vector<std::string> near_things{box("glass", -0.5, 0.2) + "," + box("water", 0.2, 0.9)};
  if (test::nightly()) near_things.push_back(box("glass", -0.5, 0.2));
  for (const std::string& near : near_things) {
    for (
        const std::string& far :
        {ball("white", 1, "1e7, 2e6, 0"), ball("white", 1e5, "0, 1e7, 0"), ball("water", 7e8, "0, 0, 1.5e11"),
         std::string(
             R"({"material": "white", "quad": {"corner": [1e7, 0, 0], "edge_u": [0, 1, 0], "edge_v": [0, 0, 1]}})")})
      EXPECT_LT(furthest(render(scene_of(near + "," + far, settings), {}).film), 2e-5) << far;
    for (
        const std::string& lights :
        {sky + R"(, {"sphere": {"center": [1e6, 0, 0], "radius": 1}, "emission": {"spectrum": 1e-3}})",
         sky +
             R"(, {"disc": {"center": [0, 1e8, 0], "normal": [0, -1, 0], "radius": 9}, "emission": {"spectrum": 1e-3}})",
         sky + R"(, {"sun": {"towards": [0, 1, 0]}, "emission": {"spectrum": 1e-3}})",
         std::string(
             R"({"sphere": {"center": [0, -9e6, 0], "radius": 1e7}, "two_sided": true, "emission": {"spectrum": 1}})")})
      EXPECT_LT(furthest(render(scene_of(near, settings, lights), {}).film), 2e-5) << lights;
  }
}

TEST(Stress, TenShellsKeepAllEnergy) {
  std::string shapes;
  for (int shell = 0; shell < 10; ++shell)
    shapes += (shell ? "," : "") + ball(shell % 3 == 0   ? "water"
                                        : shell % 3 == 1 ? "flint"
                                                         : "glass",
                                        1 - 0.09 * shell);
  const RenderResult result = render(scene_of(shapes, R"("max_depth": 4000, "roulette_depth": -1)"), {});
  EXPECT_LT(furthest(result.film), 1e-5);
}

// In matter of index n the radiance is n^2 of that in air; total reflection keeps it so.
TEST(Nesting, ACameraUnderWaterSeesTheRadianceThere) {
  const std::string shapes = ball("water", 9) + "," + ball("flint", 1) + "," + ball("air", 0.4, "0.2, 0, 0");
  const Film film = render(scene_of(shapes), {}).film;
  EXPECT_LT(furthest(film, 1.333 * 1.333), 2e-5);
}

constexpr const char* kRoom =
    R"({"name": "room", "material": "white", "sphere": {"center": [0, 0, 0], "radius": 7}})";
constexpr const char* kLamp =
    R"({"sphere": {"center": [2, 3, -2], "radius": 0.8}, "emission": {"spectrum": 1}, "two_sided": false})";

// A ball of glass in a room full of water, and one of their ratio in a room of air: the same paths, of plans
// that pilots have taught nothing, as theirs meet the surface of the water.
TEST(Nesting, OnlyTheRatioOfIndicesIsSeen) {
  const char* settings = R"("max_depth": 12)";
  const Scene wet_scene =
      scene_of(fmt::format("{}, {}, {}", kRoom, ball("water", 9), ball("glass", 1)), settings, kLamp);
  const auto samples = static_cast<std::uint64_t>(wet_scene.render.samples);
  const Film wet = test::film_of(wet_scene, make_plan(wet_scene), samples);
  const Scene dry_scene = scene_of(fmt::format("{}, {}", kRoom, ball("ratio", 1)), settings, kLamp);
  EXPECT_FALSE(dry_scene.features.nesting);
  const Film dry = test::film_of(dry_scene, make_plan(dry_scene), samples);
  double apart = 0;
  for (std::size_t pixel = 0; pixel < 24 * 24; ++pixel)
    apart = std::max(apart, std::abs(wet.mean(pixel, 0) / dry.mean(pixel, 0) - 1));
  EXPECT_LT(apart, 1e-3);
}

// Glass in a liquid of the same index at every wavelength.
TEST(Nesting, GlassInMatchingLiquidIsInvisible) {
  const auto film_of = [&](const std::string& ball_in_it) {
    return render(
               scene_of(
                   ball("oil", 6) + ball_in_it, R"("max_depth": 5, "roulette_depth": -1)",
                   R"({"quad": {"corner": [-3, -3, 3], "edge_u": [0, 3, 0], "edge_v": [6, 0, 0]}, "emission": {"spectrum": 1}},
                              {"quad": {"corner": [-3, 0, 3], "edge_u": [0, 3, 0], "edge_v": [6, 0, 0]}, "emission": {"spectrum": 3}})"),
               {})
        .film;
  };
  const Film without = film_of("");
  const Film with = film_of("," + ball("bk7", 1) + "," + ball("oil", 0.5));
  // What is absorbed on a way in pieces is the same but for rounding.
  for (std::size_t pixel = 0; pixel < 24 * 24; ++pixel)
    EXPECT_NEAR(with.mean(pixel, 0) / without.mean(pixel, 0), 1, 2e-6);
  EXPECT_GT(without.mean(0, 0), 0);
}

// A floor under water in a glass dish, and a ball in it, lit from outside: camera paths find the lamp by
// chance, photons the floor.
TEST(Nesting, CameraPathsAndPhotonsAgree) {
  const std::string shapes = fmt::format(
      R"({}, {}, {}, {{"material": "white", "quad": {{"corner": [-1, -0.9, -1], "edge_u": [0, 0, 2], "edge_v": [2, 0, 0]}}}})",
      ball("glass", 3), ball("water", 2.8), ball("flint", 0.5));
  const auto by = [&](const char* integrator, int samples) {
    Scene scene = scene_of(shapes, fmt::format(R"("max_depth": 10, "integrator": "{}")", integrator),
                           R"({"sphere": {"center": [0, 5, 0], "radius": 1.5}, "emission": {"spectrum": 1}})",
                           "0, 0.9, -1.4");
    scene.render.samples = samples;
    return render(scene, {}).film;
  };
  const int samples = test::nightly() ? 1024 : 64;
  const Film by_chance = by("path", 4 * samples);
  const Film by_photons = by("auto", samples);
  const test::Comparison agreement = test::compare_regions(by_chance, by_photons, 4);
  EXPECT_LT(agreement.largest_z, 6);
  EXPECT_NEAR(agreement.ratio, 1, test::ratio_margin(by_chance, by_photons, 0.03, 0.12));
}

}  // namespace
}  // namespace abbe

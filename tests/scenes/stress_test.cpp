// Renders where numbers are at their worst. docs/reference/validation.md lists all stress tests.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "materials/interface/prism.h"
#include "scene/shapes/ray.h"
#include "tests/angles.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

namespace abbe {
namespace {

// The furthest a pixel of the film is from 1, when `unit` is what radiance 1 exposes.
double furthest_from_one(const Film& film, const Film& unit) {
  double furthest = 0;
  for (std::size_t pixel = 0; pixel < static_cast<std::size_t>(film.width() * film.height()); ++pixel)
    for (int channel = 0; channel < film.channels(); ++channel)
      furthest = std::max(furthest, std::abs(film.mean(pixel, channel) / unit.mean(pixel, channel) - 1));
  return furthest;
}

// A camera in light of radiance 1 from everywhere, and perhaps other things; no path is ended by chance.
Scene furnace(const std::string& rest, const std::string& from = "0, 0, -4", int samples = 16) {
  return test::load_text(fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 20}}, "from": [{}], "to": [0, 0, 0], "up": [0, 1, 0]}},
    "sensor": {{"resolution": [16, 16], "response": "energy", "channels": {{"all": 1}}}},
    "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
    {}
    "render": {{"samples": {}, "max_depth": 1000, "roulette_depth": -1, "integrator": "path"}}}})",
                                     from, rest, samples));
}
const Film& empty_furnace() {
  static const Film film = render(furnace(""), {}).film;
  return film;
}

// A sphere around the camera that emits a thousandth and reflects everything: a path of a thousand vertices
// collects 1. The area of a sphere seen from within has the density of the cosine, so each sample is exact.
TEST(Stress, FurnaceOfAlbedoOneAddsUpAThousandVertices) {
  Scene scene = test::load(
      "furnace.json",
      {{"/materials/wall/diffuse/reflectance", "1"},
       {"/shapes/0/emission/spectrum", "0.001"},
       {"/sensor", R"({"resolution": [8, 8], "channels": {"all": 1}})"},
       {"/render", R"({"samples": 4, "max_depth": 999, "roulette_depth": -1, "integrator": "path"})"}});
  const Film thousand = render(scene, {}).film;
  scene.render.max_depth = 0;  // the emission seen directly
  const Film one = render(scene, {}).film;
  double mean = 0;
  for (std::size_t pixel = 0; pixel < 64; ++pixel)
    mean += thousand.mean(pixel, 0) / (1000 * one.mean(pixel, 0)) / 64;
  EXPECT_NEAR(mean, 1, 1e-4);
}

TEST(Stress, GlassSphereInAFurnaceIsNotSeen) {
  for (const char* ior : {"1.5", "2.417", "0.7", "\"hikari/F2\""}) {
    const Scene scene = furnace(fmt::format(
        R"("materials": {{"glass": {{"dielectric": {{"ior": {}}}}}}},
           "shapes": [{{"sphere": {{"center": [0, 0, 0], "radius": 1}}, "material": "glass"}}],)",
        ior));
    EXPECT_LT(furthest_from_one(render(scene, {}).film, empty_furnace()), 1e-4) << ior;
  }
}

// Light that is scattered more than once by its surface is not lost.
TEST(Stress, RoughSphereInAFurnaceIsHardlySeen) {
  for (const char* matter :
       {R"("dielectric": {"ior": 1.5, "roughness": 0.3})",
        R"("dielectric": {"ior": "hikari/F2", "roughness": 1})",
        R"("dielectric": {"ior": 0.7, "roughness": {"alpha": 0.5, "distribution": "beckmann"}})",
        R"("conductor": {"ior": 0, "roughness": [0.2, 0.8]})"}) {
    const Scene scene = furnace(fmt::format(R"("materials": {{"rough": {{{}}}}},
           "shapes": [{{"sphere": {{"center": [0, 0, 0], "radius": 1}}, "material": "rough"}}],)",
                                            matter),
                                "0, 0, -4", 64);
    const Film film = render(scene, {}).film;
    const test::Region whole = test::region(film, 0, 0, 0, 16, 16);
    const double one = test::region(empty_furnace(), 0, 0, 0, 16, 16).mean;
    EXPECT_NEAR(whole.mean / one, 1, 1e-2) << matter;
    EXPECT_GT(furthest_from_one(film, empty_furnace()), 1e-6) << "not a rough sphere: " << matter;
  }
}

// A ball of one index, rough, in a ball of another.
Scene rough_ball_within(double index, double index_around, double alpha, int samples) {
  return furnace(fmt::format(R"("materials": {{"rough": {{"dielectric": {{"ior": {}, "roughness": {}}}}},
             "around": {{"dielectric": {{"ior": {}}}}}}},
           "shapes": [{{"sphere": {{"center": [0, 0, 0], "radius": 0.5}}, "material": "rough"}},
             {{"sphere": {{"center": [0, 0, 0], "radius": 1}}, "material": "around"}}],)",
                             index, alpha, index_around),
                 "0, 0, -4", samples);
}
// The mean of the film over what radiance 1 exposes, without the noise of polarisation.
double mean_in_furnace(Scene scene) {
  scene.render.polarisation = false;
  return test::region(render(scene, {}).film, 0, 0, 0, 16, 16).mean /
         test::region(empty_furnace(), 0, 0, 0, 16, 16).mean;
}

TEST(Stress, RoughSphereInAMediumInAFurnaceIsHardlySeen) {
  for (const double around : {1.0, 1.33, 1.7, 2.4})
    for (const double alpha : {0.1, 0.2, 0.5, 1.0}) {
      EXPECT_NEAR(mean_in_furnace(rough_ball_within(1.5, around, alpha, 8)), 1, 1e-2)
          << around << " around, alpha " << alpha;
      EXPECT_NEAR(mean_in_furnace(rough_ball_within(around, 1.5, alpha, 8)), 1, 1e-2)
          << "a cavity of " << around << ", alpha " << alpha;
    }
}

// Of the media of the scene, those whose shapes are near.
TEST(Stress, RoughGlassHasTablesOfTheMediaAroundIt) {
  const Scene scene = furnace(
      R"("materials": {"rough": {"dielectric": {"ior": 1.5, "roughness": 0.5}}, "water": {"dielectric": {"ior": 1.33}},
             "diamond": {"dielectric": {"ior": 2.4}}},
           "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 0.5}, "material": "rough"},
             {"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "water"},
             {"sphere": {"center": [0, 9, 0], "radius": 1}, "material": "diamond"}],)");
  const auto rough = std::ranges::find(scene.materials, "rough", &Material::name);
  ASSERT_NE(rough, scene.materials.end());
  const auto& tables = std::get<RoughDielectricMaterial>(rough->model).surfaces_in_media;
  ASSERT_EQ(tables.size(), 1U);
  EXPECT_FLOAT_EQ(tables[0]->low_n, 1.5F / 1.33F);
}

// A path leaves the ball after some twenty events.
TEST(Stress, RoughSphereOfIndexFourInAFurnaceIsHardlySeen) {
  Scene scene = furnace(
      R"("materials": {"rough": {"dielectric": {"ior": 4, "roughness": 1}}},
         "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "rough"}],)",
      "0, 0, -4", 16);
  EXPECT_NEAR(mean_in_furnace(std::move(scene)), 1, 1e-2);
}

// From smooth surfaces to rough ones, a sphere that mirrors a lamp of some size and a sphere of glass before
// it.
TEST(Stress, AlphaSweepIsContinuous) {
  const auto film = [](double alpha) {
    return render(furnace(fmt::format(R"("materials": {{
             "metal": {{"conductor": {{"ior": "Au_Johnson", "roughness": {0}}}}},
             "glass": {{"dielectric": {{"ior": "N-SF11", "roughness": {0}}}}}, "card": {{"diffuse": {{"reflectance": 0.5}}}}}},
           "shapes": [{{"sphere": {{"center": [-0.35, 0, 0], "radius": 0.3}}, "material": "metal"}},
             {{"sphere": {{"center": [0.35, 0, 0], "radius": 0.3}}, "material": "glass"}},
             {{"quad": {{"corner": [-2, -0.4, -2], "edge_u": [0, 0, 6], "edge_v": [4, 0, 0]}}, "material": "card"}},
             {{"quad": {{"corner": [-2, -2, 4], "edge_u": [2, 0, 0], "edge_v": [0, 4, 0]}}, "material": "card", "emission": {{"spectrum": 5}}, "two_sided": true}}],)",
                                      alpha),
                          "0, 0, -4", test::nightly() ? 256 : 96),
                  {})
        .film;
  };
  std::optional<test::Region> last;
  for (const double alpha : {1e-5, 9.9e-4, 1e-3, 2e-3, 5e-3, 1e-2}) {
    const test::Region mean = test::region(film(alpha), 0, 0, 0, 16, 16);
    if (last) {
      EXPECT_NEAR(mean.mean, last->mean, 3 * std::sqrt(mean.variance + last->variance) + 1e-3 * mean.mean)
          << alpha;
    }
    last = mean;
  }
}

// The render's own steps, in float: Embree's hits, the material's refraction, the next ray.
TEST(Stress, PrismAtLeastDeviationOfTwentyWavelengths) {
  const Scene scene = furnace(
      R"("materials": {"glass": {"dielectric": {"ior": "N-SF11"}}},
         "shapes": [{"prism": {"apex_deg": 60, "side": 1, "length": 1}, "material": "glass"}],)");
  const Material& glass = scene.materials[0];
  for (int i = 0; i < 20; ++i) {
    const double nm = 400 + 18 * i;
    const auto least = prism_minimum(interior_index(glass)->n(nm), 60);
    ASSERT_TRUE(least) << nm;
    const double elevation = (least->incidence_deg - 30) * kDegree;
    const Imath::V3f start_direction(static_cast<float>(std::cos(elevation)), 0,
                                     static_cast<float>(std::sin(elevation)));
    Ray ray{Imath::V3f(-0.25F, 0.1F, 0) - start_direction, start_direction};
    const SampledSpectrum wavelengths(static_cast<float>(nm));
    for (int face = 0; face < 2; ++face) {
      const auto hit = scene.intersect(ray);
      ASSERT_TRUE(hit) << nm;
      const Basis<float> frame(hit->normal);
      const auto s = sample(make_bsdf(glass, {wavelengths}), frame.to_local(-ray.direction),
                            {0x1.fffffep-1F, {}}, 0, TransportMode::radiance);
      ASSERT_TRUE(s && s->transmitted) << nm;
      ray = spawn(hit->point, hit->normal, frame.to_world(s->wi), 0);
    }
    const Imath::V3d a(start_direction);
    const Imath::V3d b(ray.direction);
    EXPECT_NEAR(std::atan2(a.cross(b).length(), a.dot(b)), least->deviation_deg * kDegree, 1e-4) << nm;
  }
}

// Black walls, lamps without power, sensors that see none of the light: exactly 0, and every sample finite.
TEST(Stress, BlackMatterAndZeroSpectraGiveExactlyZero) {
  const auto dark = [](const std::string& reflectance, const std::string& emission,
                       const std::string& channel, const std::string& other) {
    const RenderResult result = render(test::load_text(fmt::format(R"({{"abbe": 1,
      "camera": {{"pinhole": {{"fov_deg": 40}}, "from": [0, 0, -4], "to": [0, 0, 0], "up": [0, 1, 0]}},
      "sensor": {{"resolution": [16, 16], "channels": {{"all": {2}}}}},
      "materials": {{"wall": {{"diffuse": {{"reflectance": {0}}}}}, "other": {3}}},
      "lights": [{{"point": {{"at": [2, 2, -3]}}, "emission": {{"spectrum": {1}}}}},
                 {{"sphere": {{"center": [0, 3, 0], "radius": 0.5}}, "emission": {{"spectrum": {1}}}}}],
      "shapes": [{{"quad": {{"corner": [-9, -9, 3], "edge_u": [0, 18, 0], "edge_v": [18, 0, 0]}}, "material": "wall"}},
                 {{"sphere": {{"center": [0, 0, 0], "radius": 1}}, "material": "other"}}],
      "render": {{"samples": 64}}}})",
                                                                   reflectance, emission, channel, other)),
                                       {});
    EXPECT_EQ(result.stats.nonfinite_samples, 0U);
    double largest = 0;
    for (std::size_t pixel = 0; pixel < 256; ++pixel)
      largest = std::max({largest, std::abs(result.film.mean(pixel, 0)), result.film.variance(pixel, 0)});
    return largest;
  };
  const char* kBlack = R"({"diffuse": {"reflectance": 0}})";
  const char* kGlass = R"({"dielectric": {"ior": "N-BK7"}})";
  const char* kOpaque = R"({"dielectric": {"ior": 1.5, "absorption_per_m": 1e5}})";
  const char* kMetal = R"({"conductor": {"ior": "Ag_Johnson"}})";
  EXPECT_GT(dark("0.5", "1", "1", kGlass), 0);
  EXPECT_EQ(dark("0", "1", "1", kBlack), 0);
  for (const char* other : {kBlack, kGlass, kOpaque, kMetal}) {
    EXPECT_EQ(dark("0.5", "0", "1", other), 0) << other;
    EXPECT_EQ(dark("0.5", R"({"band": [900, 1000]})", R"({"band": [500, 600]})", other), 0) << other;
    EXPECT_EQ(dark(R"({"band": [800, 900]})", R"({"band": [500, 600]})", "1", kBlack), 0) << other;
  }
}

}  // namespace
}  // namespace abbe

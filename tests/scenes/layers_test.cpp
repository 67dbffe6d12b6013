// Films told apart by the way their light came.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/part.h"
#include "transport/render/pass.h"

namespace abbe {
namespace {

RenderResult told_apart(const Scene& scene, Layers layers, RenderOptions how = {}) {
  how.layers = std::move(layers);
  return render(scene, how);
}

// The largest difference of the sum of the layers from the film, over the film's largest value.
double missing(const RenderResult& result) {
  const int planes = result.film.channels();
  const auto pixels = static_cast<std::size_t>(result.film.width() * result.film.height());
  double largest = 0;
  double difference = 0;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    for (int k = 0; k < planes; ++k) {
      double sum = 0;
      for (int i = k; i < result.layers->channels(); i += planes) sum += result.layers->mean(pixel, i);
      largest = std::max(largest, std::abs(result.film.mean(pixel, k)));
      difference = std::max(difference, std::abs(sum - result.film.mean(pixel, k)));
    }
  return largest > 0 ? difference / largest : 1;
}

// Walls of reflectance 0.8 that emit 0.2 around a meter: after k events the light is pi 0.2 0.8^k, the k-th
// term of the Neumann series of pi.
TEST(Layers, BouncesAreTheTermsOfTheNeumannSeries) {
  const Scene scene =
      test::load("validation/furnace.json", {{"/sensor/resolution", "[4, 4]"}, {"/render/samples", "2048"}});
  const RenderResult result = told_apart(scene, bounce_layers(8));
  const int planes = result.film.channels();
  for (int k = 0; k <= 8; ++k) {
    const Film::Average term = result.layers->average(k * planes + 1);
    const double expected = std::numbers::pi * std::pow(0.8, k) * (k < 8 ? 0.2 : 1);
    fmt::print("{}: {:.6f} +- {:.6f}, {:.6f}\n", k, term.mean, term.standard_error, expected);
    EXPECT_NEAR(term.mean, expected, 5 * term.standard_error + 1e-5 * expected) << k;
    EXPECT_LT(term.standard_error, 0.02 * expected) << k;
  }
}

// By day: as many as suit films this small.
std::vector<Override> few_photons() {
  if (test::nightly()) return {};
  return {{"/render/photons", R"({"per_sample": 512})"}};
}

struct Told {
  const char* scene;
  const char* integrator;
};
const std::vector<Told> kTold{{"cornell.json", "path"},
                              {"glass_sphere.json", "auto"},
                              {"cornell.json", "bdpt"},
                              {"cornell.json", "vcm"},
                              {"glass_sphere.json", "bdpt"},
                              {"cornell.json", "light"},
                              {"materials/smoke.json", "path"},
                              {"cornell.json", "sppm"},
                              {"glass_sphere.json", "photon-map"},
                              {"cornell.json", "adjoint-brute"},
                              {"validation/room.json", "photon-brute"},
                              {"validation/room.json", "sppm"}};
Scene small(const Told& told, const char* samples = "8", const char* resolution = "[32, 32]") {
  std::vector<Override> settings{{"/render/integrator", told.integrator},
                                 {"/sensor/resolution", resolution},
                                 {"/render/samples", samples}};
  const auto photons = few_photons();
  settings.insert(settings.end(), photons.begin(), photons.end());
  return test::load(told.scene, settings);
}

TEST(Layers, AddUpToTheFilmWhichStaysAsItWas) {
  for (const Told& told : kTold) {
    const Scene scene = small(told);
    const RenderResult plain = render(scene, {});
    for (const Layers& layers : {bounce_layers(2), light_layers(scene, {})}) {
      const RenderResult result = told_apart(scene, layers);
      EXPECT_EQ(result.film.bytes(), plain.film.bytes()) << told.scene << " " << told.integrator;
      EXPECT_LT(missing(result), 1e-5) << told.scene << " " << told.integrator;
    }
  }
}

// A pixel that has camera paths in one of four samples counts them four times.
TEST(Layers, AddUpWherePixelsSkipSamples) {
  const Scene scene = small(kTold[0]);
  Plan plan = make_plan(scene);
  plan.path_interval = 4;
  const RenderResult result = test::layered_film_of(plan, bounce_layers(2), 16);
  EXPECT_LT(missing(result), 1e-5);
}

// The first layers are what a render has whose paths end there, by as many samples as give eight replicates.
TEST(Layers, BouncesCountWhatMaxDepthCounts) {
  for (const Told& told : kTold) {
    // By day not of pilots, which take the most time.
    if (!test::nightly() && std::string(told.integrator) == "auto") continue;
    Scene scene = small(told, "128", test::nightly() ? "[12, 12]" : "[8, 8]");
    const RenderResult whole = told_apart(scene, bounce_layers(4));
    scene.render.max_depth = 2;
    const RenderResult cut = told_apart(scene, bounce_layers(4));
    const int planes = cut.film.channels();
    for (int k = 0; k < 5; ++k)
      for (int plane = 0; plane < planes; ++plane) {
        const Film::Average of_cut = cut.layers->average(k * planes + plane);
        const Film::Average of_whole = whole.layers->average(k * planes + plane);
        if (k > 2)
          EXPECT_EQ(of_cut.mean, 0) << told.scene << " " << told.integrator << " " << k;
        else
          EXPECT_NEAR(of_cut.mean, of_whole.mean,
                      6 * std::hypot(of_cut.standard_error, of_whole.standard_error))
              << told.scene << " " << told.integrator << " " << k;
      }
  }
}

// A lamp of each name, one of them twice, above a floor before a wall.
std::string lamps(const std::string& which, const char* integrator) {
  const auto lamp = [&](const char* name, double x, double power) {
    return fmt::format(R"({{"name": "{}", "sphere": {{"center": [{}, 0, 1], "radius": 0.1}},
      "emission": {{"spectrum": {}}}}})",
                       name, x, power);
  };
  const std::vector<std::pair<std::string, std::string>> all{{"key", lamp("key", -0.6, 3)},
                                                             {"fill in", lamp("fill in", 0.2, 1)},
                                                             {"fill in", lamp("fill in", 0.7, 2)}};
  std::vector<std::string> lit;
  for (const auto& [name, text] : all)
    if (which.empty() || which == name) lit.push_back(text);
  return fmt::format(R"({{"abbe": 1,
    "camera": {{"pinhole": {{"fov_deg": 30}}, "from": [0, -2, 3.6], "to": [0, 0, 0], "up": [0, 0, 1]}},
    "sensor": {{"resolution": [24, 24], "response": "energy",
                "channels": {{"a": {{"band": [600, 700]}}, "b": {{"band": [400, 500]}}}}}},
    "lights": [{}],
    "materials": {{"grey": {{"diffuse": {{"reflectance": 0.5}}}}}},
    "shapes": [{{"quad": {{"corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]}}, "material": "grey"}},
               {{"quad": {{"corner": [-2, 1, 0], "edge_u": [4, 0, 0], "edge_v": [0, 0, 2]}}, "material": "grey"}}],
    "render": {{"samples": {}, "integrator": "{}"}}}})",
                     fmt::join(lit, ", "), test::nightly() ? 256 : 128, integrator);
}

TEST(Layers, OfLightsAreWhatEachLightGivesAlone) {
  for (const char* integrator : {"path", "bdpt", "light", "sppm", "adjoint-brute"}) {
    const Scene all = test::load_text(lamps("", integrator), few_photons());
    const Layers layers = light_layers(all, {});
    EXPECT_EQ(layers.names, (std::vector<std::string>{"light.key", "light.fill_in"}));
    const RenderResult result = told_apart(all, layers);
    const Film key = render(test::load_text(lamps("key", integrator), few_photons()), {}).film;
    const Film fill = render(test::load_text(lamps("fill in", integrator), few_photons()), {}).film;
    for (int channel = 0; channel < 4; ++channel)
      for (int y = 0; y < 24; y += 8) {
        const test::Region layer = test::region(*result.layers, channel, 0, y, 24, y + 8);
        const test::Region alone = test::region(channel < 2 ? key : fill, channel % 2, 0, y, 24, y + 8);
        EXPECT_GT(alone.mean, 0);
        EXPECT_NEAR(layer.mean, alone.mean,
                    6 * std::sqrt(layer.variance + alone.variance) + 1e-6 * alone.mean)
            << integrator << " " << channel << " " << y;
      }
  }
}

TEST(Layers, OfSomeLightsLeaveARest) {
  const Scene all = test::load_text(lamps("", "path"));
  const Layers some = light_layers(all, {"key"});
  EXPECT_EQ(some.names, (std::vector<std::string>{"light.key", "light.rest"}));
  EXPECT_EQ(some.layer_of_light, (std::vector<std::uint32_t>{0, 1, 1}));
  EXPECT_THROW((void)light_layers(all, {"sun"}), Error);
  Scene taken = all;
  taken.lights.front().name = "rest";
  EXPECT_EQ(light_layers(taken, {}).names.front(), "light.rest");
  EXPECT_THROW((void)light_layers(taken, {"rest"}), Error);
}

TEST(Layers, LightsShareOneByTheirNameAndNotByWhatFilesMakeOfIt) {
  Scene scene = test::load_text(lamps("", "path"));
  scene.lights[0].name = scene.lights[1].name = "key 1";
  EXPECT_EQ(light_layers(scene, {}).layer_of_light, (std::vector<std::uint32_t>{0, 0, 1}));
  scene.lights[1].name = "key_1";
  EXPECT_THROW((void)light_layers(scene, {}), Error);
  EXPECT_THROW((void)light_layers(scene, {"key_1"}), Error);
  EXPECT_EQ(light_layers(scene, {scene.lights[2].name}).layer_of_light,
            (std::vector<std::uint32_t>{1, 1, 0}));
}

TEST(Layers, TheirBitsDependOnNothingButTheSamples) {
  for (const Told& told : {kTold[0], kTold[test::nightly() ? 1 : 5], kTold[2]}) {
    const Scene scene = small(told, "12");
    const FilmIdentity identity{{"sensor_channels", fmt::format("{}", fmt::join(scene.film_planes(), ","))},
                                {kLayersKey, fmt::format("{}", fmt::join(bounce_layers(3).names, ","))}};
    const RenderResult whole = told_apart(scene, bounce_layers(3), {.threads = 1});
    EXPECT_EQ(told_apart(scene, bounce_layers(3), {.threads = 3}).layers->bytes(), whole.layers->bytes());
    const auto part = [&](SampleRange range) {
      const auto path =
          std::filesystem::path(testing::TempDir()) / fmt::format("abbe_layers_{}.abbepart", ::getpid());
      RenderOptions how;
      how.samples = range;
      write_part(path, identity, told_apart(scene, bounce_layers(3), how));
      RenderPart read = read_part(path);
      std::filesystem::remove(path);
      return read;
    };
    RenderPart sum = part({5, 12});
    merge(sum, part({0, 5}), "part");
    EXPECT_EQ(sum.result.layers->bytes(), whole.layers->bytes()) << told.scene;
    const std::vector<LayerImage> images = layer_images(sum);
    ASSERT_EQ(images.size(), 4U);
    EXPECT_EQ(images[1].name, "bounce1");
    EXPECT_EQ(images[1].image.channels[0].values[500],
              static_cast<float>(whole.layers->mean(500, whole.film.channels())));
    EXPECT_EQ(images[3].image.channels.back().values[500],
              static_cast<float>(whole.layers->variance(500, whole.layers->channels() - 1)));
    RenderOptions how;
    how.layers = bounce_layers(3);
    EXPECT_EQ(render(scene, how, part({0, 7}).result).layers->bytes(), whole.layers->bytes()) << told.scene;
  }
}

}  // namespace
}  // namespace abbe

// Bidirectional path tracing beside the other techniques.
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/render.h"

namespace abbe {
namespace {

Film film_by(const char* integrator, const std::string& scene, int samples, std::vector<Override> settings) {
  settings.push_back({"/render/integrator", integrator});
  settings.push_back({"/render/samples", std::to_string(samples)});
  settings.push_back({"/sensor/resolution", test::nightly() ? "[48, 48]" : "[32, 32]"});
  return render(test::load(scene, settings), {}).film;
}

// Caustics, coats that absorb, matter in matter, reliefs, smoke and milk: the light is the same as by paths
// from the camera alone, region by region.
TEST(Bidirectional, FindsTheLightOfPathTracing) {
  const std::vector<Override> big_lamp{{"/lights/0/sphere/radius", "1.2"}};
  struct Compared {
    const char* scene;
    std::vector<Override> settings;
    int samples;
    double within = 0.015;  // of one another, all over
    bool by_day = false;
  };
  for (const auto& [scene, settings, samples, within, by_day] :
       {Compared{"glass_sphere.json", big_lamp, 256}, Compared{"cornell.json", {}, 128, 0.015, true},
        Compared{"materials/coated_glass.json", {}, 64},
        Compared{"materials/nested.json", {}, 64, 0.015, true},
        Compared{"materials/oxide_on_metal.json", {}, 64}, Compared{"materials/textures.json", {}, 64},
        Compared{"materials/smoke.json", {}, 64, 0.015, true},
        Compared{"materials/milk.json", {}, 64, 0.04}}) {
    if (!by_day && !test::nightly()) continue;
    SCOPED_TRACE(scene);
    const int paths = test::nightly() ? samples : samples / 4;
    const Film path = film_by("path", scene, 2 * paths, settings);
    const Film both = film_by("bdpt", scene, paths, settings);
    const test::Comparison c = test::compare_regions(path, both, 4);
    EXPECT_LT(c.largest_z, test::kLargestZ);
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(path, both, within, 0.08));
  }
}

// A lamp that shines up at a ceiling from close by: what camera paths meet, hardly any connection of theirs
// lights.
TEST(Bidirectional, FindsLightThatConnectionsOfPathTracingDoNot) {
  const std::string scene = R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 40}, "from": [0, 1, -4], "to": [0, 1, 0], "up": [0, 1, 0]},
    "sensor": {"resolution": [16, 16], "observer": "1931"},
    "materials": {"grey": {"diffuse": {"reflectance": 0.6}}},
    "lights": [{"name": "lamp", "quad": {"corner": [-0.1, 1.9, -0.1], "edge_u": [0, 0, 0.2],
                                         "edge_v": [0.2, 0, 0]}, "emission": {"spectrum": 1, "radiance": 100}}],
    "shapes": [{"name": "ceiling", "quad": {"corner": [-2, 2, -2], "edge_u": [4, 0, 0], "edge_v": [0, 0, 4]},
                "material": "grey"},
               {"name": "floor", "quad": {"corner": [-2, 0, -2], "edge_u": [0, 0, 4], "edge_v": [4, 0, 0]},
                "material": "grey"}],
    "render": {"samples": 256, "integrator": "INTEGRATOR"}})";
  const auto by = [&](const std::string& integrator) {
    std::string text = scene;
    text.replace(text.find("INTEGRATOR"), 10, integrator);
    return test::load_text(text);
  };
  const auto film = [&](const std::string& integrator) { return render(by(integrator), {}).film; };
  const Film path = film("path");
  const Film both = film("bdpt");
  const test::Comparison c = test::compare_regions(path, both, 2);
  EXPECT_LT(c.largest_z, test::kLargestZ);
  const auto variance = [](const Film& f) {
    double sum = 0;
    for (std::size_t pixel = 0; pixel < 256; ++pixel) sum += f.variance(pixel, 1);
    return sum;
  };
  EXPECT_LT(10 * variance(both), variance(path));
  Scene larger = by("auto");
  larger.camera.width = 128;
  larger.camera.height = 128;
  const IntegratorChoice choice = choose_integrator(larger, 2);
  EXPECT_EQ(choice.integrator, Integrator::bdpt) << choice.cost_ratio.value_or(0);
  EXPECT_NE(choice.reason.find("times as cheap"), std::string::npos) << choice.reason;
}

// A ball of cloud 60 free paths thick seen from its lit side, and a white room with a ball in it, where most
// light has more events than all are joined at.
TEST(Bidirectional, JoinsLongPathsAtSomeOfTheirVerticesForAll) {
  const char* cloud = R"(
    "camera": {"pinhole": {"fov_deg": 28}, "from": [0, -4, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
    "materials": {"cloud": {"medium": {"scattering_per_m": 30}}},
    "lights": [{"directional": {"towards": [0, -1, 0], "irradiance": 1}}],
    "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "cloud"}])";
  const char* room = R"(
    "camera": {"pinhole": {"fov_deg": 60}, "from": [0, -0.9, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
    "materials": {"white": {"diffuse": {"reflectance": 0.95}}, "copper": {"conductor": {"ior": "Cu_Johnson", "roughness": 0.4}}},
    "lights": [{"sphere": {"center": [0.4, -0.2, 0.5], "radius": 0.1}, "emission": {"spectrum": 1}}],
    "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "white"},
               {"sphere": {"center": [0.2, 0.3, 0], "radius": 0.3}, "material": "copper"}])";
  struct Compared {
    const char* scene;
    int paths;
    int joined;
  };
  for (const auto& [scene, paths, joined] : {Compared{cloud, 1024, 192}, Compared{room, 512, 48}}) {
    const auto by = [scene = scene](const char* integrator, int samples) {
      const Film film = render(test::load_text(fmt::format(
                                   R"({{"abbe": 1, {}, "sensor": {{"resolution": [8, 8], "channels":
          {{"a": {{"band": [500, 600]}}}}}}, "render": {{"integrator": "{}", "samples": {}, "max_depth": 60}}}})",
                                   scene, integrator, samples)),
                               {})
                            .film;
      return test::region(film, 0, 0, 0, 8, 8);
    };
    const test::Region path = by("path", paths);
    for (const char* integrator : {"bdpt", "vcm"}) {
      const test::Region both = by(integrator, joined);
      const double deviation = std::sqrt(path.variance + both.variance) / path.mean;
      std::printf("%s: %.4f of path, deviation %.4f\n", integrator, both.mean / path.mean, deviation);
      EXPECT_NEAR(both.mean / path.mean, 1, 5 * deviation) << integrator;
      EXPECT_LT(deviation, 0.02) << integrator;
    }
  }
}

}  // namespace
}  // namespace abbe

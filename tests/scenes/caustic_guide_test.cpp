// Caustics that camera paths find by what photons have shown them.
#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/plan/plan.h"
#include "transport/render/cost.h"
#include "transport/render/trained_plan.h"
#include "transport/technique/caustic_photons.h"

namespace abbe {
namespace {

struct Mean {
  double value = 0;
  double variance = 0;
};
Mean mean_of(const Film& film) {
  const test::Region all = test::whole(film, 1);
  return {all.mean, all.variance};
}

// A small lamp in the middle of a bulb of thin glass over a grey floor. All light meets the glass along its
// normal, where it lets T = (1 - R)/(1 + R) through, R = ((n - 1)/(n + 1))^2 = 1/25 of either face.
std::string lamp_over_floor(bool bulb) {
  return std::string(R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 8}, "from": [4, 2, 0], "to": [1, 0, 0], "up": [0, 1, 0]},
    "sensor": {"resolution": [8, 8], "observer": "1931"},
    "materials": {"grey": {"diffuse": {"reflectance": 0.5}}, "black": {"diffuse": {"reflectance": 0}},
                  "glass": {"thin_glass": {"ior": 1.5}}},
    "lights": [{"name": "lamp", "sphere": {"center": [0, 2, 0], "radius": 0.01},
                "emission": {"spectrum": 1, "radiance": 100}}],
    "shapes": [{"name": "floor", "quad": {"corner": [-9, 0, -9], "edge_u": [0, 0, 18], "edge_v": [18, 0, 0]},
                "material": "grey"})") +
         (bulb ? R"(, {"name": "bulb", "sphere": {"center": [0, 2, 0], "radius": 0.5}, "material": "glass"})"
               : "") +
         R"(], "render": {"integrator": "path", "roulette_depth": 1}})";
}

TEST(CausticGuide, ALampInABulbIsAsBrightAsItsGlassLetsThrough) {
  constexpr double kThrough = 24.0 / 26;
  const Scene open = test::load_text(lamp_over_floor(false));
  const Scene closed = test::load_text(lamp_over_floor(true));
  const Mean bare = mean_of(test::film_of(open, make_plan(open), 256));
  const Plan guided_plan = make_trained_plan(closed, 2);
  ASSERT_FALSE(guided_plan.guides.path_caustics.empty());
  const Mean guided = mean_of(test::film_of(closed, guided_plan, 1024));
  EXPECT_NEAR(guided.value / bare.value, kThrough, 4.5 * std::sqrt(guided.variance) / bare.value);
  EXPECT_LT(std::sqrt(guided.variance) / guided.value, 0.01);

  // Less than one path in a thousand samples finds it by chance.
  const Mean chance = mean_of(test::film_of(closed, make_plan(closed), 16384));
  EXPECT_GT(16 * chance.variance, 50 * guided.variance);
}

// So does merging, of photons that no camera path could have been connected with.
TEST(Merging, FindsALampInABulbAsBrightAsItsGlassLetsThrough) {
  constexpr double kThrough = 24.0 / 26;
  const auto seen = [](bool bulb, const char* integrator, const char* samples) {
    const Scene scene = test::load_text(lamp_over_floor(bulb), {{"/camera/pinhole/fov_deg", "40"},
                                                                {"/sensor/resolution", "[128, 128]"},
                                                                {"/render/integrator", integrator},
                                                                {"/render/photons/radius", "0.05"},
                                                                {"/render/samples", samples}});
    return mean_of(render(scene, {}).film);
  };
  const Mean open = seen(false, "path", "64");
  const Mean closed = seen(true, "vcm", "64");
  const double error =
      std::hypot(std::sqrt(closed.variance), kThrough * std::sqrt(open.variance)) / open.value;
  std::printf("%.5f of it, standard error %.5f\n", closed.value / open.value / kThrough, error);
  EXPECT_LT(error, 0.0018);
  EXPECT_NEAR(closed.value / open.value, kThrough, 0.006);
}

// Whatever scatters where the caustic falls, with the guide and without it the light is the same: diffuse
// matter, facets, matter that mirrors as well, what lets light through.
TEST(CausticGuide, ChangesNoiseOnly) {
  std::vector<const char*> floors{
      R"({"mixture": [{"material": "mirror", "weight": 0.5}, {"material": "white", "weight": 0.5}]})"};
  if (test::nightly()) {
    floors.push_back(R"({"coated_diffuse": {"ior": 1.5, "reflectance": 0.5}})");
    floors.push_back(R"({"diffuse": {"reflectance": 0.5}})");
    floors.push_back(R"({"conductor": {"ior": "Au_Johnson", "roughness": 0.5}})");
  }
  for (const char* floor : floors) {
    const Scene scene =
        test::load("glass_sphere.json", {{"/sensor/resolution", "[48, 48]"},
                                         {"/lights/0/sphere/radius", "2"},
                                         {"/materials/mirror", R"({"mirror": {"reflectance": 0.9}})"},
                                         {"/materials/white", R"({"diffuse": {"reflectance": 0.6}})"},
                                         {"/materials/grey", floor},
                                         {"/render/integrator", "path"}});
    const Plan guided = make_trained_plan(scene, 2);
    ASSERT_FALSE(guided.guides.path_caustics.empty());
    const Film a = test::film_of(scene, make_plan(scene), 512);
    const Film b = test::film_of(scene, guided, 504);
    EXPECT_LT(test::compare_regions(a, b, 4).largest_z, test::kLargestZ) << floor;
    const Mean chance = mean_of(a);
    const Mean found = mean_of(b);
    EXPECT_NEAR(found.value, chance.value, 4.5 * std::sqrt(found.variance + chance.variance)) << floor;
    EXPECT_LT(std::sqrt(found.variance + chance.variance), 0.012 * found.value) << floor;
  }
}

// Photons bring the caustic that is seen directly, and camera paths, guided, the one that is seen through a
// pane: nothing twice.
TEST(NightlyCausticGuide, LooksBehindAPaneForWhatPhotonsBringBesideIt) {
  const std::string pane =
      R"({"name": "pane", "quad": {"corner": [1.5, 0.1, -6], "edge_u": [2, 0, 1], "edge_v": [0, 4, 0]}, )"
      R"("material": "pane"})";
  std::vector<Override> settings{{"/sensor/resolution", "[48, 48]"},
                                 {"/lights/0/sphere/radius", "0.45"},
                                 {"/materials/pane", R"({"thin_glass": {"ior": 1.5}})"},
                                 {"/shapes/2", pane}};
  Scene both = test::load("glass_sphere.json", settings);
  both.features.light_tracing = true;
  both.features.light_is_traced[0] = true;
  settings.push_back({"/render/integrator", "path"});
  const Scene paths = test::load("glass_sphere.json", settings);
  const Plan plan = make_trained_plan(both, 2);
  ASSERT_TRUE(traces(plan.techniques, TracedPaths::light));
  ASSERT_TRUE(plan.guides.path_caustics.empty());
  ASSERT_FALSE(plan.guides.caustics_through_specular.empty());
  const Film guided = test::film_of(both, plan, 512);
  const Film chance = test::film_of(paths, make_plan(paths), 2048);
  const test::Comparison c = test::compare_regions(chance, guided, 4);
  EXPECT_LT(c.largest_z, test::kLargestZ);
  EXPECT_NEAR(c.ratio, 1, 0.01);
}

// What the guide learns from has come through glass or by a mirror alone.
TEST(CausticPhotons, ComeThroughSpecularMatterAlone) {
  const Scene scene = test::load(
      "glass_sphere.json",
      {{"/shapes/2",
        R"({"name": "wall", "quad": {"corner": [-9, 0, 3], "edge_u": [18, 0, 0], "edge_v": [0, 9, 0]}, "material": "grey"})"}});
  std::vector<bool> lamp(scene.lights.size(), false);
  lamp[0] = true;
  const Emissions emissions = emissions_of(scene);
  const std::optional<Plan> plan = make_photon_plan(scene, emissions, lamp);
  ASSERT_TRUE(plan);
  RayCaster caster(scene);
  CausticPhotonTracer tracer(*plan, caster, emissions.sensor_emissions);
  std::vector<Sampler> photons;
  for (std::uint32_t i = 0; i < 4096; ++i) photons.emplace_back(1, Purpose::pilot, 0, 0, i);
  const auto arrived = tracer.trace(photons);
  EXPECT_GT(arrived.size(), 200U);
  for (const auto& [start, photon] : arrived) {
    const auto back = scene.intersect(ray_at(photon.point + photon.from * 1e-6F, photon.from, 0));
    ASSERT_TRUE(back);
    EXPECT_EQ(scene.shapes[back->shape].name, "ball");
    EXPECT_NEAR(photon.last_distance, back->t, 3e-6F);
    EXPECT_GT(photon.path_distance, photon.last_distance);
    EXPECT_GT(photon.power, 0);
  }
}

// A scene that asks for no guide has none: nothing specular, nothing that scatters behind it, a light that
// photons bring wherever the camera sees it, or one that no path can meet.
TEST(CausticGuide, IsNotMadeWhereItFindsNothing) {
  const auto guides = [](const Scene& scene) {
    const Plan plan = make_trained_plan(scene, 2);
    return !plan.guides.path_caustics.empty() || !plan.guides.caustics_through_specular.empty();
  };
  EXPECT_FALSE(guides(test::load("cornell.json")));
  EXPECT_FALSE(guides(test::load("prism_area.json")));
  EXPECT_FALSE(guides(test::load("spectrograph.json")));
  EXPECT_TRUE(guides(test::load("glass_sphere.json")));
}

// Photons cannot start from a lamp that stands half in glass, as the others are told; camera paths do
// without.
TEST(CausticGuide, IsNotMadeOfALampInTwoKindsOfMatter) {
  const auto half_in_glass = [](const char* integrator) {
    return test::load(
        "glass_sphere.json",
        {{"/lights/0",
          R"({"name": "lamp", "quad": {"corner": [0, 1, -0.1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 0.2]}, "emission": {"spectrum": 1}})"},
         {"/render/integrator", integrator}});
  };
  const Scene joined = half_in_glass("bdpt");
  EXPECT_TRUE(refusal(joined));
  for (const char* integrator : {"path", "auto"}) {
    const Scene scene = half_in_glass(integrator);
    EXPECT_FALSE(refusal(scene));
    EXPECT_TRUE(make_trained_plan(scene, 2).guides.path_caustics.empty());
  }
}

TEST(CausticGuide, IsTheSameOnAnyNumberOfThreads) {
  const Scene scene = test::load("glass_sphere.json", {{"/sensor/resolution", "[8, 8]"}});
  const Plan one = make_trained_plan(scene, 1);
  const Plan four = make_trained_plan(scene, 4);
  const auto floor = static_cast<float>(bounds(scene.shapes[0].shape).center().y);
  int lobes = 0;
  for (int i = 0; i < 1000; ++i) {
    const Imath::V3f point(static_cast<float>(i % 10) * 4e-4F, floor, static_cast<float>(i / 10) * 4e-5F);
    const Imath::V3f up = Imath::V3f(-0.4F, 1, -0.3F).normalized();
    const CausticLobes a = one.guides.caustics_through_specular.at(point);
    const CausticLobes b = four.guides.caustics_through_specular.at(point);
    ASSERT_EQ(a.empty(), b.empty());
    ASSERT_EQ(a.probability(), b.probability());
    ASSERT_EQ(a.pdf(point, up), b.pdf(point, up));
    lobes += a.empty() ? 0 : 1;
  }
  EXPECT_GT(lobes, 50);
}

// The room of the bench with a ball of that material and walls of that albedo; an open one has a black
// ceiling and a black wall behind the camera.
Scene bright_room(const char* ball, double albedo, bool open) {
  std::vector<Override> settings{{"/sensor/resolution", "[12, 12]"},
                                 {"/materials/ball", ball},
                                 {"/materials/white/diffuse/reflectance", std::to_string(albedo)},
                                 {"/render/integrator", "path"}};
  if (open)
    for (const char* wall : {"/shapes/0/material", "/shapes/1/material"}) settings.push_back({wall, "black"});
  return test::load_file(data_directory() / "bench" / "bright_room.json", settings);
}

// Mean over the pixels of the relative variance of a render, from several seeds, times its CPU time.
struct Noise {
  double variance = 0;
  double cpu_s = 0;
  double mean = 0;
  [[nodiscard]] double cost() const { return variance * cpu_s; }
};
Noise noise_of(const Plan& plan, std::uint64_t samples) {
  constexpr std::uint64_t kSeeds = 12;
  const double before = process_cpu_seconds();
  std::vector<Film> films;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    films.push_back(test::film_of(plan.scene, plan, samples, seed));
  Noise noise{0, process_cpu_seconds() - before};
  const auto pixels = static_cast<std::size_t>(plan.scene.camera.width * plan.scene.camera.height);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    double sum = 0;
    double squares = 0;
    for (const Film& film : films) {
      sum += film.mean(pixel, 1);
      squares += film.mean(pixel, 1) * film.mean(pixel, 1);
    }
    const double mean = sum / kSeeds;
    if (!(mean > 0)) continue;  // a black wall
    noise.mean += mean / static_cast<double>(pixels);
    noise.variance += (squares / kSeeds - mean * mean) * kSeeds / (kSeeds - 1) / (mean * mean);
  }
  return noise;
}

// The caustic guide does not add noise to light that scattering finds as well, however deep the paths are.
// The ratio of CPU times is printed but not tested: other tests run at the same time.
TEST(CausticGuide, MakesNoBrightRoomNoisier) {
  std::vector<std::pair<const char*, const char*>> balls{
      {"silver", R"({"conductor": {"ior": "Ag_Johnson"}})"}, {"glass", R"({"dielectric": {"ior": 1.5}})"}};
  std::vector<double> albedos{0.9};
  if (test::nightly()) {
    balls.emplace_back("gold", R"({"conductor": {"ior": "Au_Johnson"}})");
    balls.emplace_back("mirror", R"({"mirror": {"reflectance": 1}})");
    albedos = {0.5, 0.8, 0.9, 0.95};
  }
  for (const auto& [name, ball] : balls)
    for (const double albedo : albedos)
      for (const bool open : {false, true}) {
        if (open && !test::nightly()) continue;
        const Scene scene = bright_room(ball, albedo, open);
        const Plan guided = make_trained_plan(scene, 1);
        ASSERT_FALSE(guided.guides.path_caustics.empty());
        const std::uint64_t samples = test::nightly() ? 256 : 32;
        const Noise without = noise_of(make_plan(scene), samples);
        const Noise with = noise_of(guided, samples);
        std::printf(
            "%s, albedo %.2f, %s: variance %.2f, CPU time %.2f, both %.2f of those without (%.4f %.4f)\n",
            name, albedo, open ? "open" : "closed", with.variance / without.variance,
            with.cpu_s / without.cpu_s, with.cost() / without.cost(), with.mean, without.mean);
        EXPECT_LT(with.variance, 1.2 * without.variance) << name << " " << albedo << " " << open;
      }
}

}  // namespace
}  // namespace abbe

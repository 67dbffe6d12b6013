// Techniques that gather photons or wait for them, beside those that connect paths.
#include <cmath>

#include "scene/lost_light.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/render.h"

namespace abbe {
namespace {

struct Rendered {
  std::string integrator;
  int samples;
  std::vector<Override> settings = {};
};

Film film_of(const Rendered& how, const std::string& text) {
  std::vector<Override> settings = how.settings;
  settings.push_back({"/render/integrator", "\"" + how.integrator + "\""});
  settings.push_back({"/render/samples", std::to_string(how.samples)});
  return render(test::load_text(text, settings), {}).film;
}

// Means of a channel over quarters of a film.
std::array<double, 4> quarters(const Film& film, int channel) {
  std::array<double, 4> means{};
  for (std::size_t i = 0; i < 4; ++i) {
    const int x = static_cast<int>(i % 2) * film.width() / 2;
    const int y = static_cast<int>(i / 2) * film.height() / 2;
    means.at(i) = test::region(film, channel, x, y, x + film.width() / 2, y + film.height() / 2).mean;
  }
  return means;
}

double mean_of(const Film& film) {
  return test::whole(film, 1).mean;
}

// Both films alike all over within `whole`, and in each quarter within `quarter`.
void expect_alike(const Film& a, const Film& b, double whole, double quarter) {
  double sum_a = 0;
  double sum_b = 0;
  for (int channel = 0; channel < a.channels(); ++channel) {
    const auto of_a = quarters(a, channel);
    const auto of_b = quarters(b, channel);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(of_b.at(i) / of_a.at(i), 1, quarter) << "quarter " << i << ", channel " << channel;
      sum_a += of_a.at(i);
      sum_b += of_b.at(i);
    }
  }
  EXPECT_NEAR(sum_b / sum_a, 1, whole);
}

// A ball of dispersive glass on a table, under a lamp, the caustic seen through a pane.
std::string ball_under(const std::string& lamp, const std::string& glass = R"({"ior": "N-SF11"})") {
  return R"({"abbe": 1,
    "camera": {"thin_lens": {"focal_length": 0.05, "f_number": 2}, "from": [0, -2.2, 2.6], "to": [0.5, 0.5, 0],
               "up": [0, 0, 1]},
    "sensor": {"resolution": [16, 16], "observer": "1931", "pixel_pitch_um": 1600},
    "materials": {"table": {"diffuse": {"reflectance": 0.7}}, "pane": {"thin_glass": {"ior": 1.5}},
                  "glass": {"dielectric": )" +
         glass + R"(}},
    "lights": [)" +
         lamp + R"(],
    "shapes": [{"name": "table", "quad": {"corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]},
                "material": "table"},
               {"name": "ball", "sphere": {"center": [0.5, 0.5, 0.9], "radius": 0.35}, "material": "glass"},
               {"name": "pane", "quad": {"corner": [-1, -1.6, 1.2], "edge_u": [2, 0, 0], "edge_v": [0, 1, 1]},
                "material": "pane"}],
    "render": {"photons": {"radius": 0.02, "per_sample": 16384}}})";
}
const std::string kBigLamp = R"({"name": "lamp", "sphere": {"center": [0.8, 0.6, 3], "radius": 0.8},
  "emission": {"illuminant": "D65", "luminance": 1000}})";
const std::string kPointLamp = R"({"name": "bulb", "point": {"at": [0.5, 0.5, 2.5]},
  "emission": {"illuminant": "D65", "luminous_flux_lm": 1000}})";

// Caustics that are seen through glass, of a lamp so large that paths meet it without being told where it is.
TEST(NightlyPhotons, MergingFindsCausticsSeenThroughGlassAsBruteForceDoes) {
  const std::string scene = ball_under(kBigLamp);
  const Film brute = film_of({"adjoint-brute", 16384}, scene);
  // The film positions of progressive photon mapping are few: those of a replicate, whatever its samples.
  const std::vector<Override> finer{{"/sensor/resolution", "[64, 64]"}, {"/sensor/pixel_pitch_um", "400"}};
  const std::vector<Override> fine{{"/sensor/resolution", "[32, 32]"}, {"/sensor/pixel_pitch_um", "800"}};
  std::vector<Rendered> merging{{"vcm", 256, fine}};
  if (test::nightly())
    merging.insert(merging.end(), {{"path", 1024}, {"sppm", 256, fine}, {"ppm", 256, finer}});
  for (const Rendered& how : merging) {
    SCOPED_TRACE(how.integrator);
    expect_alike(brute, film_of(how, scene), 0.01, 0.03);
  }
}

// A point lamp's, which nothing else finds: merging alone and merging beside connections agree, and
// connections alone say that they miss them.
TEST(Photons, MergingFindsTheCausticsOfAPoint) {
  const std::string scene = ball_under(kPointLamp);
  const std::vector<Override> finer{{"/sensor/resolution", "[64, 64]"}, {"/sensor/pixel_pitch_um", "400"}};
  const Film merged = film_of({"sppm", 64, finer}, scene);
  expect_alike(merged, film_of({"vcm", 64, finer}, scene), 0.01, 0.03);
  EXPECT_LT(mean_of(film_of({"bdpt", 64, finer}, scene)), 0.95 * mean_of(merged));
  const auto unreached_by = [&scene](const char* integrator) {
    const Scene loaded =
        test::load_text(scene, {{"/render/integrator", std::string("\"") + integrator + "\""}});
    return unsampled_paths(loaded, loaded.features, false);
  };
  ASSERT_EQ(unreached_by("bdpt").size(), 1U);
  ASSERT_EQ(unreached_by("sppm").size(), 1U);
  EXPECT_EQ(unreached_by("sppm")[0].substr(0, 7), "E S+ L:");
  EXPECT_EQ(unreached_by("vcm"), unreached_by("sppm"));
}

// Matter that scatters and absorbs, reliefs, coats and matter within matter: what photons bring is the light
// of path tracing.
TEST(NightlyPhotons, GatheringFindsTheLightOfPathTracing) {
  struct Compared {
    const char* scene;
    const char* radius;
    double within;
    bool by_day = false;
  };
  for (const auto& [scene, radius, within, by_day] :
       {Compared{"cornell.json", "4", 0.01}, Compared{"materials/smoke.json", "0.02", 0.02, true},
        Compared{"materials/textures.json", "0.03", 0.01, true},
        Compared{"materials/nested.json", "0.3", 0.02}}) {
    if (!by_day && !test::nightly()) continue;
    const auto film = [&, name = scene, r = radius](const char* integrator, int samples) {
      return render(test::load(name, {{"/render/integrator", integrator},
                                      {"/render/samples", std::to_string(samples)},
                                      {"/sensor/resolution", "[32, 32]"},
                                      {"/render/photons",
                                       std::string(R"({"per_sample": 16384, "radius": )") + r + "}"}}),
                    {})
          .film;
    };
    const Film path = film("path", 512);
    for (const char* integrator : {"sppm", "vcm"}) {
      SCOPED_TRACE(std::string(scene) + " by " + integrator);
      expect_alike(path, film(integrator, 128), within, 4 * within);
    }
  }
}

// Fog that lets some wavelengths through better than others, so that no two lanes are as likely to have come.
// By day not by stochastic progressive photon mapping.
TEST(NightlyPhotons, MergingBehindColouredFogFindsTheLightOfPathTracing) {
  const std::string fog = R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -3, 1], "to": [0, 0, 0.6], "up": [0, 0, 1]},
    "sensor": {"resolution": [32, 32], "observer": "1931"},
    "materials": {"white": {"diffuse": {"reflectance": 0.8}},
                  "fog": {"medium": {"scattering_per_m": {"table": {"wavelength_nm": [400, 700],
                                     "values": [0.6, 0.15], "outside": "clamp"}}, "absorption_per_m": 0.05}}},
    "lights": [{"name": "lamp", "sphere": {"center": [0.6, 0.4, 1.4], "radius": 0.4},
                "emission": {"illuminant": "D65", "luminance": 1000}}],
    "shapes": [{"name": "fog", "sphere": {"center": [0, 0, 0], "radius": 3.4}, "material": "fog"},
               {"name": "floor", "quad": {"corner": [-2, -2, 0], "edge_u": [4, 0, 0], "edge_v": [0, 4, 0]},
                "material": "white"},
               {"name": "wall", "quad": {"corner": [-2, 1, 0], "edge_u": [4, 0, 0], "edge_v": [0, 0, 3]},
                "material": "white"}],
    "render": {"photons": {"radius": 0.1}}})";
  const Film path = film_of({"path", 1024}, fog);
  expect_alike(path, film_of({"vcm", 128}, fog), 0.01, 0.03);
  if (!test::nightly()) return;
  // Whose pixels share their photons, and so their errors.
  expect_alike(path, film_of({"sppm", 128}, fog), 0.02, 0.05);
}

// Progressive photon mapping looks at the same places in all samples of a replicate, stochastic progressive
// photon mapping at new ones: of a lamp seen from beside its edge.
TEST(Photons, OnlyOfTheStochasticKindArePlacesDrawnAnew) {
  const std::string lamp = R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 30}, "from": [0, -4, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [8, 8], "observer": "1931"},
    "lights": [{"name": "lamp", "sphere": {"center": [0, 0, 0], "radius": 0.5},
                "emission": {"spectrum": 1, "radiance": 1}}]})";
  const auto partly_lit = [&](const char* integrator, int samples) {
    const Film film = film_of({integrator, samples}, lamp);
    double most = 0;
    for (std::size_t pixel = 0; pixel < 64; ++pixel) most = std::max(most, film.mean(pixel, 1));
    int odd = 0;  // pixels of which neither none nor half nor all of two places is lit
    for (std::size_t pixel = 0; pixel < 64; ++pixel) {
      const double halves = 2 * film.mean(pixel, 1) / most;
      odd += std::abs(halves - std::round(halves)) > 0.2 ? 1 : 0;
    }
    return odd;
  };
  EXPECT_EQ(partly_lit("ppm", 16), 0);  // of two replicates
  EXPECT_GT(partly_lit("sppm", 16), 8);
}

// The blur of the nearest photons falls with their number, and a final gather takes it off what is not a
// caustic.
TEST(Photons, MapsBlurLessTheMorePhotonsThereAre) {
  const auto error = [](const char* photons) {
    const std::vector<Override> small{{"/sensor/resolution", "[32, 32]"}, {"/render/samples", "32"}};
    std::vector<Override> by_map = small;
    by_map.push_back({"/render/integrator", "photon-map"});
    by_map.push_back({"/render/photons", photons});
    static const Film kPath =
        render(test::load("cornell.json", {{"/sensor/resolution", "[32, 32]"}, {"/render/samples", "512"}}),
               {})
            .film;
    const Film film = render(test::load("cornell.json", by_map), {}).film;
    return mean_of(film) / mean_of(kPath) - 1;
  };
  const double few = error(R"({"per_sample": 1000, "nearest": 50})");
  const double many = error(R"({"per_sample": 16000, "nearest": 50})");
  const double gathered = error(R"({"per_sample": 16000, "nearest": 50, "final_gather": true})");
  EXPECT_LT(few, -0.03);  // the walls' edges lose light
  EXPECT_LT(std::abs(many), std::abs(few) / 3);
  EXPECT_LT(std::abs(gathered), 0.85 * std::abs(many));  // the first of the bounces is not blurred
}

// What a lamp in glass sends through fog to a floor that lies in the shade of all else: matter scatters it
// after the floor, so that no photon of a caustic brings it there.
TEST(NightlyPhotons, AFinalGatherMeetsLampsInGlassThroughFog) {
  const std::string scene = R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 20}, "from": [0, 0, 0.5], "to": [0, 0, 0], "up": [0, 1, 0]},
    "sensor": {"resolution": [4, 4], "channels": {"Y": {"band": [500, 600]}}},
    "materials": {"grey": {"diffuse": {"reflectance": 0.5}}, "black": {"diffuse": {"reflectance": 0}},
                  "glass": {"dielectric": {"ior": 1.5}}, "fog": {"medium": {"scattering_per_m": 0.5}}},
    "lights": [{"sphere": {"center": [3, 0, 1], "radius": 0.95}, "emission": {"spectrum": 1, "radiance": 1000}}],
    "shapes": [{"quad": {"corner": [-0.5, -0.5, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]}, "material": "grey"},
               {"sphere": {"center": [3, 0, 1], "radius": 1}, "material": "glass"},
               {"quad": {"corner": [1.2, -1.5, -1], "edge_u": [0, 3, 0], "edge_v": [0, 0, 2]}, "material": "black"},
               {"sphere": {"center": [0, 0, 0], "radius": 6}, "material": "fog"}],
    "render": {"max_depth": 30, "photons": {"per_sample": 512, "nearest": 50, "final_gather": true}}})";
  const auto mean = [&](const Rendered& how) {
    const Film film = film_of(how, scene);
    return test::whole(film).mean;
  };
  EXPECT_NEAR(mean({"photon-map", test::by_night(4096, 2048)}) / mean({"path", 8192}), 1, 0.2);
}

// Photons that find an opening by themselves, from the lamps, see what paths that leave it do: in coloured
// glass that takes some of them, and off a metal.
TEST(NightlyBruteForce, PhotonsAndTheirAdjointsAgree) {
  const std::string scene = ball_under(
      kBigLamp,
      R"({"ior": 1.5, "absorption_per_m": {"gaussian": {"center_nm": 620, "fwhm_nm": 150, "peak": 2}}})");
  const std::vector<Override> wide{{"/camera/thin_lens", R"({"focal_length": 1.5, "f_number": 0.6})"},
                                   {"/sensor/resolution", "[2, 2]"},
                                   {"/sensor/pixel_pitch_um", "700000"},
                                   {"/render/photons", R"({"per_sample": 100000})"}};
  const Film path = film_of({"path", 65536, wide}, scene);
  expect_alike(path, film_of({"adjoint-brute", 1048576, wide}, scene), 0.01, 0.03);
  expect_alike(path, film_of({"photon-brute", test::by_night(64, 32), wide}, scene), 0.05, 0.15);
  if (!test::nightly()) return;
  std::vector<Override> bladed = wide;
  bladed.push_back({"/camera/thin_lens/blades", "4"});
  expect_alike(film_of({"path", 65536, bladed}, scene), film_of({"photon-brute", 64, bladed}, scene), 0.05,
               0.15);
}

// At the corners of a film that the lens does not fill no path begins.
TEST(BruteForce, AdjointPhotonsThatNoLensLetsThroughAreNotTraced) {
  const Scene scene = test::load_text(
      R"({"abbe": 1, "camera": {"lens_system": {"prescription": "double_gauss", "f_number": 16}, "from": [0, 0, 0],
          "to": [0, 1, 0], "up": [0, 0, 1]},
        "sensor": {"resolution": [4, 4], "observer": "1931", "pixel_pitch_um": 40000},
        "lights": [{"name": "sky", "environment": {}, "emission": {"spectrum": 1}}],
        "render": {"integrator": "adjoint-brute", "samples": 64}})");
  const RenderResult result = render(scene, {});
  EXPECT_GT(mean_of(result.film), 0);
  EXPECT_GT(result.stats.rays, 0U);
  EXPECT_LT(result.stats.rays, result.stats.paths / 2);
}

}  // namespace
}  // namespace abbe

#include "transport/render/choose_integrator.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "description/load.h"
#include "io/data_directory.h"
#include "transport/render/render.h"
#include "transport/render/technique_balance.h"
#include "transport/render/trained_plan.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

Scene load(const fs::path& scene, std::vector<Override> settings = {}) {
  settings.insert(settings.begin(), {"/sensor/resolution", "[128, 128]"});
  Diagnostics diagnostics;
  auto loaded = load_scene(data_directory() / scene, settings, diagnostics);
  EXPECT_TRUE(loaded) << diagnostics.text();
  return *std::move(loaded);
}

TEST(ChooseIntegrator, LeavesLampsThatAreConnectedToEasilyToPathTracing) {
  for (const char* plain : {"scenes/cornell.json", "bench/metals.json"}) {
    const IntegratorChoice choice = choose_integrator(load(plain), 2);
    EXPECT_EQ(choice.integrator, Integrator::automatic) << plain;
    EXPECT_LT(choice.cost_ratio.value_or(9), 1) << plain;
    EXPECT_EQ(choice.reason, "") << plain;
  }
}

// The lamp turned to the ceiling, not far below it: paths from the camera seldom find what it lights.
Scene indirect_cornell() {
  return load(
      "scenes/cornell.json",
      {{"/lights/0/quad", R"({"corner": [343, 450, 227], "edge_u": [-130, 0, 0], "edge_v": [0, 0, 105]})"}});
}

// What one sample's error costs by path tracing with photons beside it at their best share, over what it
// costs by bidirectional path tracing, whose rays count double: by pilots through so many pixels.
double cost_ratio_of(const Scene& scene, std::uint32_t pixels) {
  Scene joining = scene;
  joining.render.integrator = Integrator::bdpt;
  const TechniqueStatistics apart = measure_techniques(make_trained_plan(scene, 2), 2, pixels);
  const TechniqueStatistics joined = measure_techniques(make_plan(joining), 2, pixels, apart.region_means);
  const double by_chance = joined.path_tracing_square - (apart.path_square - apart.path_variance);
  const double apart_root = std::sqrt(std::max(apart.path_variance, by_chance) * apart.path_rays) +
                            std::sqrt(apart.photon_variance * apart.photon_rays);
  return apart_root * apart_root / (2 * joined.path_rays * (joined.path_variance + joined.photon_variance));
}

// Of sunlight through a hole onto a drop, photons that are not guided find so little that each of them seems
// to be the mean of its region.
TEST(ChooseIntegrator, KnowsTheNoiseOfLightThatItFindsByRareChance) {
  const IntegratorChoice choice = choose_integrator(load("scenes/rainbow.json"), 2);
  EXPECT_EQ(choice.integrator, Integrator::automatic);
  EXPECT_LT(choice.cost_ratio.value_or(0), 0.1);
}

TEST(ChooseIntegrator, JoinsWhereThatCostsSoMuchLessAtEqualError) {
  const Scene scene = indirect_cornell();
  const IntegratorChoice choice = choose_integrator(scene, 2);
  EXPECT_EQ(choice.integrator, Integrator::bdpt);
  ASSERT_TRUE(choice.cost_ratio);
  EXPECT_GT(*choice.cost_ratio, 1.5);
  EXPECT_DOUBLE_EQ(*choice.cost_ratio, cost_ratio_of(scene, 4096));
  EXPECT_NE(choice.reason.find("times as cheap"), std::string::npos) << choice.reason;
}

// A narrow spot lights a small place on the floor, which lights the fog: of that paths from the camera find
// so little that their own pilots do not know of it, and joined ones do.
TEST(ChooseIntegrator, KnowsOfLightThatPathTracingFindsByRareChance) {
  const Scene scene = load("bench/beam.json");
  const IntegratorChoice choice = choose_integrator(scene, 2);
  EXPECT_EQ(choice.integrator, Integrator::bdpt);
  EXPECT_GT(choice.cost_ratio.value_or(0), 10);
  EXPECT_EQ(choice.guides, nullptr) << "those of path tracing";
}

// What joined paths tell of the mean square of path tracing, where each of its paths has one contribution:
// all but what falls to connections with the lens.
TEST(TechniquePilots, JoinedPathsTellWhatPathTracingWouldHave) {
  Scene scene = load("scenes/cornell.json", {{"/lights/0", R"({"point": {"at": [278, 400, 279]},
                                        "emission": {"illuminant": "A", "luminous_flux_lm": 1000}})"},
                                             {"/render/max_depth", "1"},
                                             {"/render/integrator", "path"}});
  const double square = measure_techniques(make_plan(scene), 2).path_square;
  scene.render.integrator = Integrator::bdpt;
  const TechniqueStatistics joined = measure_techniques(make_plan(scene), 2);
  EXPECT_LT(joined.path_tracing_square, 1.02 * square);
  EXPECT_GT(joined.path_tracing_square, 0.8 * square);
  EXPECT_LT(joined.path_square, 0.75 * square);
}

// Within a sphere of the reflectance r, lit from its middle, each path of path tracing has r^k at its event
// k, and the squares of these are to be told, over that of their sum: of joined paths, of which all but the
// first eight vertices are joined by chance, too.
TEST(TechniquePilots, JoinedPathsTellWhatPathTracingWouldHaveOfLongPaths) {
  constexpr double kReflectance = 0.97;
  constexpr int kEvents = 40;
  Scene scene = load(
      "scenes/cornell.json",
      {{"/units", "\"m\""},
       {"/camera", R"({"pinhole": {"fov_deg": 60}, "from": [0, -0.9, 0], "to": [0, 0, 0], "up": [0, 0, 1]})"},
       {"/materials", R"({"white": {"diffuse": {"reflectance": 0.97}}})"},
       {"/lights", R"([{"point": {"at": [0, 0, 0]}, "emission": {"spectrum": 1}}])"},
       {"/shapes", R"([{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "white"}])"},
       {"/render/max_depth", fmt::format("{}", kEvents)},
       {"/render/roulette_depth", "-1"},
       {"/render/integrator", "path"}});
  double sum = 0;
  double squares = 0;
  for (int k = 1; k <= kEvents; ++k) {
    sum += std::pow(kReflectance, k);
    squares += std::pow(kReflectance, 2 * k);
  }
  const double square = measure_techniques(make_plan(scene), 2, 512).path_square;
  scene.render.integrator = Integrator::bdpt;
  const double told = measure_techniques(make_plan(scene), 2, 512).path_tracing_square;
  const double of_each = told / square / (squares / (sum * sum));
  std::printf("%.3f of the squares, but for what falls to connections with the lens\n", of_each);
  EXPECT_LT(of_each, 1.02);
  EXPECT_GT(of_each, 0.8);
}

// Where few pixels say that joining is not worth it, no more are asked. All light of one lamp comes through
// a bulb, which paths from the camera find where photons have shown them; under the other both have a part.
TEST(ChooseIntegrator, StopsWhereItIsPlainByWhatIsLearnt) {
  for (const char* file : {"bench/bulb.json", "scenes/glass_sphere.json"}) {
    const Scene scene = load(file);
    const IntegratorChoice choice = choose_integrator(scene, 2);
    EXPECT_EQ(choice.integrator, Integrator::automatic) << file;
    EXPECT_DOUBLE_EQ(choice.cost_ratio.value_or(0), cost_ratio_of(scene, 512)) << file;
  }
}

// Photons bring all of the film's light. Few of those that are not guided arrive, and each would be the mean
// of its region: relative to their own means joining would seem far cheaper.
TEST(ChooseIntegrator, MeasuresBothAgainstTheMeansOfGuidedPhotons) {
  const Scene scene = load("scenes/prism_area.json");
  const IntegratorChoice choice = choose_integrator(scene, 2);
  EXPECT_EQ(choice.integrator, Integrator::automatic);
  EXPECT_LT(choice.cost_ratio.value_or(1), 0.01);
  EXPECT_DOUBLE_EQ(choice.cost_ratio.value_or(0), cost_ratio_of(scene, 512));
}

// Variances per pixel that pilots of films of different sizes find, which are nearly independent: their mean,
// their standard deviation, and the root mean square of the errors that the pilots report.
struct VarianceOfPilots {
  double mean, scatter, reported;
};
VarianceOfPilots variance_of_pilots(const char* file) {
  constexpr int kFilms = 32;
  std::vector<double> variances;
  double squares = 0;
  for (int i = 0; i < kFilms; ++i) {
    const double pixels = (64.0 + i) * (64 - i);
    const Scene scene = load(file, {{"/render/integrator", "path"},
                                    {"/sensor/resolution", fmt::format("[{}, {}]", 64 + i, 64 - i)}});
    const TechniqueStatistics found = measure_techniques(make_plan(scene), 2, 512);
    variances.push_back(found.path_variance / pixels);
    squares += std::pow(found.path_variance_error / pixels, 2) / kFilms;
  }
  double mean = 0;
  for (const double variance : variances) mean += variance / kFilms;
  double scatter = 0;
  for (const double variance : variances) scatter += std::pow(variance - mean, 2) / (kFilms - 1);
  std::printf("%s: variance %.3g, scatter %.3g, reported %.3g\n", file, mean, std::sqrt(scatter),
              std::sqrt(squares));
  return {mean, std::sqrt(scatter), std::sqrt(squares)};
}

// A few paths that meet the lamp through glass by chance hold nearly all of the variance, so that its
// estimate is uncertain; in the Cornell box no path does. The reported error is that of the scatter. With n
// films of kurtosis k the scatter is known to sqrt((k - 1)/(4 n)), a quarter for n = 32 and k = 9.
TEST(TechniquePilots, ReportTheErrorOfAVarianceThatFewPathsHold) {
  const VarianceOfPilots rare = variance_of_pilots("scenes/glass_sphere.json");
  EXPECT_GT(rare.reported, rare.scatter / 1.5);
  EXPECT_LT(rare.reported, rare.scatter * 1.5);
  const VarianceOfPilots common = variance_of_pilots("scenes/cornell.json");
  EXPECT_GT(common.reported, common.scatter / 1.5);
  EXPECT_LT(common.reported, common.scatter * 1.5);
  EXPECT_GT(rare.reported / rare.mean, 2 * common.reported / common.mean);
}

TEST(ChooseIntegrator, IsTheSameOfAnySeedOnAnyNumberOfThreads) {
  const Scene scene = load("scenes/glass_sphere.json");
  const Scene other = load("scenes/glass_sphere.json", {{"/render/seed", "7"}});
  EXPECT_EQ(choose_integrator(scene, 1).cost_ratio, choose_integrator(other, 3).cost_ratio);
}

// A render by what the choice has learnt is the one that learns it again.
TEST(ChooseIntegrator, PassesOnWhatItsPilotsHaveLearnt) {
  for (const char* integrator : {"auto", "path"}) {
    const Scene scene =
        load("scenes/glass_sphere.json", {{"/sensor/resolution", "[24, 16]"},
                                          {"/render/samples", "4"},
                                          {"/render/integrator", fmt::format("\"{}\"", integrator)}});
    const IntegratorChoice choice = choose_integrator(scene, 2);
    ASSERT_NE(choice.guides, nullptr);
    const auto film = [&](const std::shared_ptr<const GuidingData>& guides) {
      const RenderResult rendered = render(scene, {.threads = 2, .guides = guides});
      return std::string(rendered.film.bytes());
    };
    EXPECT_EQ(film(choice.guides), film(nullptr));
    EXPECT_NE(film(std::make_shared<const GuidingData>(make_plan(scene).guides)), film(nullptr));
  }
}

// Twelve pixels with paths of two hundred vertices, of which each pair has 40,000 connections.
TEST(ChooseIntegrator, SpendsNothingOnFilmsOfFewPixels) {
  const Scene scene =
      load("scenes/cornell.json", {{"/sensor/resolution", "[4, 3]"}, {"/render/max_depth", "200"}});
  EXPECT_FALSE(choose_integrator(scene, 2).cost_ratio);
}

// Nor where paths, in a closed sphere, cost more than their film is worth, though it could pay for shorter
// ones.
TEST(ChooseIntegrator, SpendsLittleOnLongPaths) {
  const auto cost_ratio = [](const std::string& depth) {
    return choose_integrator(
               load("scenes/furnace.json", {{"/render/max_depth", depth}, {"/render/roulette_depth", "-1"}}),
               2)
        .cost_ratio;
  };
  EXPECT_TRUE(cost_ratio("3"));
  EXPECT_FALSE(cost_ratio("200"));
}

TEST(ChooseIntegrator, LeavesWhatIsAskedFor) {
  const Scene scene = load("scenes/cornell.json", {{"/render/integrator", "path"}});
  EXPECT_EQ(choose_integrator(scene, 2).integrator, Integrator::path);
}

// The caustic of a point seen through a pane.
TEST(ChooseIntegrator, MergesOnlyWhereThatIsAllowedAndFindsMore) {
  const std::vector<Override> pane{
      {"/lights/0", R"({"name": "lamp", "point": {"at": [0, 6, 0]}, "emission": {"spectrum": 1}})"},
      {"/materials/pane", R"({"thin_glass": {"ior": 1.5}})"},
      {"/shapes/2", R"({"name": "pane", "quad": {"corner": [1.5, 0.1, -6], "edge_u": [4, 0, 2],
                        "edge_v": [0, 4, 0]}, "material": "pane"})"}};
  EXPECT_NE(choose_integrator(load("scenes/glass_sphere.json", pane), 2).integrator, Integrator::vcm);
  std::vector<Override> allowed = pane;
  allowed.push_back({"/render/consistent", "true"});
  const IntegratorChoice choice = choose_integrator(load("scenes/glass_sphere.json", allowed), 2);
  EXPECT_EQ(choice.integrator, Integrator::vcm);
  EXPECT_NE(choice.reason.find("only photon merging samples E S (S|D)* D (S|D)* S L"), std::string::npos)
      << choice.reason;
  EXPECT_NE(choose_integrator(load("scenes/cornell.json", {{"/render/consistent", "true"}}), 2).integrator,
            Integrator::vcm);
}

}  // namespace
}  // namespace abbe

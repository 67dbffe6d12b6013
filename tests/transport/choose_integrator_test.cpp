#include "transport/render/choose_integrator.h"

#include <gtest/gtest.h>

#include "description/load.h"
#include "io/data_directory.h"

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
    EXPECT_EQ(choice.because, "") << plain;
  }
}

TEST(ChooseIntegrator, IsTheSameOnAnyNumberOfThreads) {
  const Scene scene = load("scenes/cornell.json");
  EXPECT_EQ(choose_integrator(scene, 1).cost_ratio, choose_integrator(scene, 3).cost_ratio);
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
  EXPECT_NE(choice.because.find("merging finds E S (S|D)* D (S|D)* S L"), std::string::npos)
      << choice.because;
  EXPECT_NE(choose_integrator(load("scenes/cornell.json", {{"/render/consistent", "true"}}), 2).integrator,
            Integrator::vcm);
}

}  // namespace
}  // namespace abbe

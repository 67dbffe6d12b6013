#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/cost.h"

namespace abbe {
namespace {

bool same_film(const Film& a, const Film& b) {
  for (std::size_t pixel = 0; pixel < static_cast<std::size_t>(a.width() * a.height()); ++pixel)
    for (int channel = 0; channel < a.channels(); ++channel)
      if (a.mean(pixel, channel) != b.mean(pixel, channel) ||
          a.variance(pixel, channel) != b.variance(pixel, channel))
        return false;
  return true;
}

struct Rendered {
  const char* scene;
  const char* integrator;
};

class SameBits : public testing::TestWithParam<Rendered> {};

TEST_P(SameBits, WhateverTheNumberOfThreads) {
  const Scene scene = test::load(GetParam().scene, {{"/render/integrator", GetParam().integrator},
                                                    {"/sensor/resolution", "[80, 45]"},
                                                    {"/render/samples", test::nightly() ? "20" : "10"}});
  const RenderResult one = render(scene, {.threads = 1});
  ASSERT_GT(frame_mean_error(one.film), 0);
  for (const int threads : test::nightly() ? std::vector{2, 5} : std::vector{5})
    EXPECT_TRUE(same_film(one.film, render(scene, {.threads = threads}).film)) << threads;
}

TEST_P(SameBits, AnotherSeedIsAnotherFilm) {
  const std::vector<Override> small{{"/render/integrator", GetParam().integrator},
                                    {"/sensor/resolution", "[80, 45]"},
                                    {"/render/samples", "4"}};
  std::vector<Override> reseeded = small;
  reseeded.push_back({"/render/seed", "1"});
  EXPECT_FALSE(same_film(render(test::load(GetParam().scene, small), {}).film,
                         render(test::load(GetParam().scene, reseeded), {}).film));
}

INSTANTIATE_TEST_SUITE_P(Scenes, SameBits,
                         testing::Values(Rendered{"prism.json", "auto"}, Rendered{"cornell.json", "auto"},
                                         Rendered{"glass_sphere.json", "auto"},
                                         Rendered{"glass_sphere.json", "bdpt"},
                                         Rendered{"glass_sphere.json", "sppm"},
                                         Rendered{"cornell.json", "ppm"}, Rendered{"cornell.json", "vcm"},
                                         Rendered{"glass_sphere.json", "photon-map"},
                                         Rendered{"cornell.json", "adjoint-brute"}),
                         [](const auto& info) {
                           const char* scene = info.param.scene;
                           std::string name(scene, std::strchr(scene, '.'));
                           name += std::string("_") + info.param.integrator;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Needs only skip what would add nothing. The technique of tracing light takes over paths from another, so
// that with it the film is the same in expectation.
TEST(SceneFeatures, ForcedOnLeaveTheFilm) {
  const std::vector<Override> small{{"/sensor/resolution", "[32, 32]"},
                                    {"/render/samples", test::nightly() ? "64" : "24"}};
  const Scene plain = test::load("cornell.json", small);
  const RenderResult expected = render(plain, {});
  for (const FeatureName& need : feature_names()) {
    Scene scene = test::load("cornell.json", small);
    ASSERT_FALSE(scene.features.*need.member) << need.key;
    scene.features.*need.member = true;
    scene.features.light_is_traced.assign(scene.lights.size(), need.member == &SceneFeatures::light_tracing);
    const RenderResult forced = render(scene, {});
    if (need.member != &SceneFeatures::light_tracing) {
      EXPECT_TRUE(same_film(expected.film, forced.film)) << need.key;
      continue;
    }
    EXPECT_GT(forced.stats.paths, expected.stats.paths) << "no photon was traced";
    const test::Comparison c = test::compare_regions(expected.film, forced.film, 4);
    EXPECT_LT(c.largest_z, 5.6) << need.key;
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(expected.film, forced.film, 0.01, 0.04)) << need.key;
  }
}

TEST(Crop, PixelsInsideAreThoseOfTheWholeFilm) {
  const char* samples = test::nightly() ? "4" : "2";
  for (const char* integrator : {"path", "bdpt", "sppm", "vcm", "photon-map"}) {
    const Scene scene = test::load("cornell.json", {{"/render/integrator", integrator},
                                                    {"/sensor/resolution", "[64, 64]"},
                                                    {"/render/samples", samples}});
    const RenderResult whole = render(scene, {});
    const RenderResult part = render(scene, {.crop = Crop{10, 20, 30, 40}});
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const auto pixel = static_cast<std::size_t>(y * 64 + x);
        const bool inside = x >= 10 && x < 30 && y >= 20 && y < 40;
        EXPECT_EQ(part.film.mean(pixel, 0), inside ? whole.film.mean(pixel, 0) : 0)
            << integrator << ": " << x << ", " << y;
      }
  }
}

// Of two processes, the other of which does as much as the first.
TEST(MpiGroup, CostsAreThoseOfAll) {
  const Scene scene = test::load("cornell.json", {{"/sensor/resolution", "[64, 64]"},
                                                  {"/render/samples", test::nightly() ? "256" : "96"}});
  RenderOptions options;
  options.mpi_group = {.rank = 0,
                       .size = 2,
                       .reduce =
                           [](std::span<Int128> numbers) {
                             for (Int128& n : numbers) n *= 2;
                           },
                       .broadcast = [](std::uint64_t said) { return said; }};
  const double before = process_cpu_seconds();
  const RenderResult result = render(scene, options);
  const double own = process_cpu_seconds() - before;
  EXPECT_EQ(result.stats.processes, 2);
  EXPECT_NEAR(result.stats.cpu_s, 2 * own, 0.1 * own);
}

TEST(Stop, ARequestEndsAfterAPassWithAValidFilm) {
  const Scene scene =
      test::load("cornell.json", {{"/sensor/resolution", "[32, 32]"}, {"/render/samples", "4096"}});
  std::atomic<bool> stop{false};
  const RenderResult stopped =
      render(scene, {.stop = &stop, .progress = [&stop](const Progress&) { stop = true; }});
  EXPECT_TRUE(stopped.stats.interrupted);
  EXPECT_GT(stopped.stats.samples_per_pixel, 0U);
  EXPECT_LT(stopped.stats.samples_per_pixel, 4096U);
  EXPECT_GT(stopped.film.mean(16 * 32 + 16, 1), 0);
}

// Of small films a sample has far more photons than camera paths.
TEST(Stop, PhotonsCountForTheLengthOfAPass) {
  const Scene scene = test::load("cornell.json", {{"/sensor/resolution", "[2, 2]"},
                                                  {"/render/integrator", "\"sppm\""},
                                                  {"/render/photons", R"({"per_sample": 32768})"},
                                                  {"/render/samples", "32"}});
  std::atomic<bool> stop{false};
  const RenderResult stopped =
      render(scene, {.stop = &stop, .progress = [&stop](const Progress&) { stop = true; }});
  EXPECT_EQ(stopped.stats.samples_per_pixel, 8U);
}

TEST(Progress, RateAndTimeLeftAreThoseOfThisRun) {
  const Scene scene =
      test::load("cornell.json", {{"/sensor/resolution", "[64, 64]"}, {"/render/samples", "250"}});
  RenderResult start = render(scene, {.samples = SampleRange{0, 128}});
  std::vector<Progress> told;
  const RenderResult result =
      render(scene, {.threads = 1, .progress = [&](const Progress& progress) { told.push_back(progress); }},
             std::move(start));
  EXPECT_EQ(result.stats.samples_before, 128U);
  ASSERT_GT(told.size(), 1U);
  for (const Progress& progress : told) {
    const double traced = static_cast<double>(progress.samples - 128);
    EXPECT_NEAR(progress.fraction_done, static_cast<double>(progress.samples) / 250, 1e-12);
    EXPECT_GE(progress.rate, traced / progress.elapsed_s);
    EXPECT_NEAR(progress.left_s * progress.rate, static_cast<double>(250 - progress.samples), 1e-6);
  }
  EXPECT_LT(told.back().rate, 250 / told.back().elapsed_s) << "planning is less than half of it";
  EXPECT_EQ(told.back().error_samples, 250U);
  EXPECT_EQ(told.back().error.median, result.stats.error.median);
}

TEST(Stop, AnErrorTargetIsReached) {
  const Scene scene = test::load("cornell.json", {{"/sensor/resolution", "[32, 32]"}});
  const RenderResult result = render(scene, {.target_error = 0.1});
  EXPECT_LE(result.stats.error.median, 0.1);
}

}  // namespace
}  // namespace abbe

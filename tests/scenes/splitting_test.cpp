// Camera paths that go on in several where they first scatter: the expected film is that of whole ones.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "tests/scenes/film_of_plan.h"
#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/layers.h"
#include "transport/render/technique_balance.h"
#include "transport/render/trained_plan.h"

namespace abbe {
namespace {

struct Case {
  const char* scene;
  std::vector<Override> settings = {};
  std::uint64_t samples = 128;
};

// Of matt walls; behind a lens that takes lanes to pixels of their own; of glass, fog and a Stokes sensor.
const std::vector<Case> kCases{
    {"cornell.json"},
    {"portrait.json"},
    {"glass_sphere.json", {{"/lights/0/sphere/radius", "1.2"}}, 512},
    {"materials/smoke.json"},
    {"stokes.json", {}, 512},
};

Scene small(const Case& of) {
  std::vector<Override> settings = of.settings;
  settings.push_back({"/sensor/resolution", "[16, 16]"});
  settings.push_back({"/render/integrator", "path"});
  return test::load(of.scene, settings);
}

Plan split_plan(const Scene& scene, int bits) {
  Plan plan = make_plan(scene);
  plan.log2_splits = bits;
  return plan;
}

TEST(Splitting, ChangesNoiseOnly) {
  for (const Case& of : kCases) {
    const std::uint64_t samples = of.samples * (test::nightly() ? 16 : 1);
    SCOPED_TRACE(of.scene);
    const Scene scene = small(of);
    const Film whole = test::film_of(scene, split_plan(scene, 0), 4 * samples, 1);
    for (const int bits : {1, 2, 3}) {
      const Film split =
          test::film_of(scene, split_plan(scene, bits), samples, 2 + static_cast<std::uint64_t>(bits));
      const test::Comparison c = test::compare_regions(whole, split, 4);
      EXPECT_LT(c.largest_z, test::kLargestZ) << bits;
      EXPECT_NEAR(c.ratio, 1, test::ratio_margin(whole, split, 0.02, 0.05)) << bits;
    }
  }
}

// Of the box all but a fifth of the variance is of light that was scattered more than once.
TEST(Splitting, LeavesLessVarianceForAsManyPaths) {
  const Scene scene = small(kCases[0]);
  const auto variance_of = [&scene](int bits) {
    const Film film = test::film_of(scene, split_plan(scene, bits), 512, 1);
    double sum = 0;
    for (std::size_t pixel = 0; pixel < 256; ++pixel) sum += film.variance(pixel, 1);
    return sum;
  };
  const double whole = variance_of(0);
  EXPECT_LT(variance_of(1), 0.7 * whole);
  EXPECT_LT(variance_of(2), 0.45 * whole);
  EXPECT_LT(variance_of(3), 0.25 * whole);
}

TEST(Splitting, HasTheSameBitsHoweverSamplesAndThreadsArePartedAndCroppedOut) {
  for (const Case& of : kCases) {
    const Scene scene = small(of);
    const Plan plan = split_plan(scene, 2);
    const auto film_of = [&](const std::vector<SampleRange>& ranges, const std::optional<Crop>& crop,
                             int threads) {
      Film film(16, 16, static_cast<int>(scene.film_planes().size()), 8, plan.nominal_value,
                paths_to_any_pixel(plan), plan.path_interval, crop);
      for (const SampleRange& range : ranges)
        Pass(plan, film, crop, range, 0, 7).run(threads, [] { return false; });
      film.set_samples(count_per_replicate({{0, 24}}, 8));
      return film;
    };
    const Film film = film_of({{0, 24}}, {}, 1);
    EXPECT_EQ(film.bytes(), film_of({{0, 24}}, {}, 3).bytes()) << of.scene;
    EXPECT_EQ(film.bytes(), film_of({{11, 24}, {0, 3}, {3, 11}}, {}, 2).bytes()) << of.scene;
    const Film part = film_of({{0, 24}}, Crop{3, 5, 14, 9}, 2);
    for (int y = 5; y < 9; ++y)
      for (int x = 3; x < 14; ++x)
        EXPECT_EQ(part.mean(part.pixel_at(x, y), 0), film.mean(film.pixel_at(x, y), 0)) << of.scene;
  }
}

// What each part finds is told to the layers once, with its share.
TEST(Splitting, LayersAddUp) {
  const Scene scene = small(kCases[0]);
  const Plan plan = split_plan(scene, 2);
  const Layers layers = bounce_layers(2);
  const RenderResult result = test::layered_film_of(plan, layers, 16);
  for (int channel = 0; channel < 3; ++channel) {
    double sum = 0;
    for (int layer = 0; layer < static_cast<int>(layers.names.size()); ++layer)
      sum += result.layers->average(layer * 3 + channel).mean;
    EXPECT_NEAR(sum, result.film.average(channel).mean, 1e-5 * sum);
  }
}

TEST(Splitting, GoesOnAsItWouldHaveOnAnyNumberOfThreads) {
  const Scene scene = test::load("cornell.json", {{"/sensor/resolution", "[112, 112]"}});
  RenderOptions options;
  options.samples = SampleRange{0, 12};
  options.threads = 1;
  const RenderResult whole = render(scene, options);
  EXPECT_EQ(whole.stats.path_splitting, 4);
  EXPECT_EQ(whole.stats.paths, 12U * 112 * 112);
  options.threads = 3;
  options.samples = SampleRange{0, 5};
  RenderResult part = render(scene, options);
  options.samples = SampleRange{0, 12};
  const RenderResult end = render(scene, options, std::move(part));
  EXPECT_EQ(end.film.bytes(), whole.film.bytes());
  EXPECT_EQ(end.stats.rays, whole.stats.rays);
}

// Where pilots find it cheaper: in the box, whose noise is of light scattered twice and more, and not in a
// furnace, whose paths all find the same; nor for films that cost less than their pilots, nor where `path` is
// asked for.
TEST(Splitting, IsWhereLightFoundLaterIsTheNoise) {
  const auto learnt = [](const char* file, const char* resolution, int threads, const char* by = "auto") {
    const Scene scene = test::load(file, {{"/sensor/resolution", resolution}, {"/render/integrator", by}});
    Plan plan = make_trained_plan(scene, 2);
    choose_path_splitting(plan, threads);
    return plan.log2_splits;
  };
  EXPECT_EQ(learnt("cornell.json", "[160, 160]", 1), 3);
  EXPECT_EQ(learnt("cornell.json", "[160, 160]", 3), 3);
  EXPECT_EQ(learnt("furnace.json", "[128, 128]", 2), 0);
  EXPECT_EQ(learnt("cornell.json", "[128, 128]", 2), 2) << "eight take more rays than pilots may cast";
  EXPECT_EQ(learnt("cornell.json", "[96, 96]", 2), 1) << "so do four";
  EXPECT_EQ(learnt("cornell.json", "[64, 64]", 2), 0);
  EXPECT_EQ(learnt("cornell.json", "[85, 96]", 2), 0);
  EXPECT_EQ(learnt("cornell.json", "[128, 128]", 2, "path"), 0);
}

}  // namespace
}  // namespace abbe

// Camera paths that go where the noise is: the film is that of as many samples, for less.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <set>

#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/learn_density.h"
#include "transport/render/learnt_plan.h"
#include "transport/render/pass.h"

namespace abbe {
namespace {

Scene small(const std::vector<Override>& settings = {}) {
  std::vector<Override> all{{"/sensor/resolution", "[16, 16]"}, {"/render/integrator", "path"}};
  all.insert(all.end(), settings.begin(), settings.end());
  return test::load("cornell.json", all);
}

Film film_of(const Plan& plan, std::uint64_t samples, int replicates = 2) {
  const Camera& camera = plan.scene.camera;
  Film film(camera.width, camera.height, static_cast<int>(plan.scene.film_planes().size()), replicates,
            plan.nominal_value, paths_to_any_pixel(plan), plan.path_interval);
  Pass(plan, film, {}, {0, samples}, 0, 0).run(2, [] { return false; });
  film.set_samples(count_per_replicate({{0, samples}}, replicates));
  return film;
}

// The density of each quarter of the film of 16 x 16 pixels.
SamplingDensity quarters(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
  return {0, 0, 8, 2, {a, b, c, d}};
}

TEST(SamplingDensity, HoldsForItsBlocksAloneAndIsElsewhereOne) {
  const SamplingDensity density{4, 2, 3, 2, {8, 4, 2, 1}};
  EXPECT_EQ(density.at(4, 2), 8U);
  EXPECT_EQ(density.at(6, 4), 8U);
  EXPECT_EQ(density.at(7, 4), 4U);
  EXPECT_EQ(density.at(4, 5), 2U);
  for (const auto& [x, y] : {std::pair{3, 2}, {4, 1}, {10, 2}, {4, 8}}) EXPECT_EQ(density.at(x, y), 1U);
  EXPECT_EQ(SamplingDensity().at(5, 5), 1U);
}

// Four paths of a sample in a pixel are those of four samples with one each.
TEST(SamplingDensity, ManyPathsOfASampleAreThoseOfAsManySamples) {
  const Scene scene = small();
  Plan plan = make_plan(scene);
  std::vector<Film> alike;
  for (const int times : {1, 2, 4, 8}) alike.push_back(film_of(plan, 4U * static_cast<unsigned>(times)));
  plan.density = quarters(1, 2, 4, 8);
  const Film film = film_of(plan, 4);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const Film& same = alike[static_cast<std::size_t>(y / 8 * 2 + x / 8)];
      const std::size_t pixel = film.pixel_at(x, y);
      EXPECT_NEAR(film.mean(pixel, 1), same.mean(pixel, 1), 1e-12 * same.mean(pixel, 1)) << x << " " << y;
    }
}

// A lens takes lanes, and its ghosts light, to other pixels than the path's.
TEST(SamplingDensity, CountsWhatFallsOnOtherPixelsAsThePathsItIsOf) {
  const Scene scene = test::load("star_field.json", {{"/sensor/resolution", "[16, 16]"},
                                                     {"/render/integrator", "path"},
                                                     {"/camera/lens_system/ghosts", "true"}});
  Plan plan = make_plan(scene);
  const Film alike = film_of(plan, 64);
  plan.density = {0, 0, 16, 1, {4}};
  const Film film = film_of(plan, 16);
  EXPECT_GT(alike.average(1).mean, 0);
  for (std::size_t pixel = 0; pixel < 256; ++pixel)
    EXPECT_NEAR(film.mean(pixel, 1), alike.mean(pixel, 1), 1e-9 * alike.average(1).mean);
}

// Of two samples one has both paths: those of its number, or of the next where the pixel begins late.
TEST(SamplingDensity, PixelsThatSkipSamplesHaveAllOfTheirPathsInOthers) {
  const Scene scene = small();
  Plan plan = make_plan(scene);
  const auto total_of = [&plan](std::uint64_t samples) {
    const Film film = film_of(plan, samples, 1);
    std::vector<double> totals;
    for (std::size_t pixel = 0; pixel < 256; ++pixel) totals.push_back(film.total(pixel, 1));
    return totals;
  };
  const std::vector<double> first = total_of(2);
  const std::vector<double> all = total_of(8);
  const std::vector<double> more = total_of(10);
  plan.path_interval = 2;
  plan.density = quarters(2, 2, 2, 2);
  const std::vector<double> skipping = total_of(8);
  int late = 0;
  for (std::size_t pixel = 0; pixel < 256; ++pixel) {
    const bool begins_late = std::abs(skipping[pixel] / all[pixel] - 1) > 1e-9;
    const double expected = begins_late ? more[pixel] - first[pixel] : all[pixel];
    EXPECT_NEAR(skipping[pixel], expected, 1e-9 * more[pixel]) << pixel;
    late += begins_late ? 1 : 0;
  }
  EXPECT_GT(late, 64);
  EXPECT_LT(late, 192);
}

TEST(LearnDensity, IsOfSceneAndCropAlone) {
  const Scene scene = small({{"/sensor/resolution", "[96, 96]"}});
  Plan plan = make_plan(scene);
  learn_density(plan, {}, 1);
  const std::vector<std::uint8_t> whole = plan.density.paths;
  ASSERT_EQ(whole.size(), 144U);
  EXPECT_GT(std::set<std::uint8_t>(whole.begin(), whole.end()).size(), 2U);
  EXPECT_EQ(*std::min_element(whole.begin(), whole.end()), 1);
  Plan again = make_plan(scene);
  learn_density(again, {}, 3);
  EXPECT_EQ(again.density.paths, whole);
  learn_density(again, Crop{20, 10, 84, 74}, 2);
  EXPECT_EQ(again.density.paths.size(), 64U);
  EXPECT_EQ(again.density.at(19, 10), 1U);
}

// Where every pixel is as noisy as the next, or none is noisy, paths are spread alike.
TEST(LearnDensity, LeavesPixelsAlikeWhereThatIsBest) {
  for (const char* scene : {"furnace.json", "validation/furnace.json"}) {
    const Scene even = test::load(scene, {{"/render/integrator", "path"}});
    Plan plan = make_plan(even);
    learn_density(plan, {}, 2);
    EXPECT_TRUE(plan.density.paths.empty()) << scene;
  }
  const Scene joined = small({{"/render/integrator", "bdpt"}});
  Plan plan = make_plan(joined);
  learn_density(plan, {}, 2);
  EXPECT_TRUE(plan.density.paths.empty());
}

// Blocks grow with the film, so that pilots do not.
TEST(LearnDensity, LargeFilmsHaveNoMorePilotsThanOthers) {
  const Scene scene = small({{"/sensor/resolution", "[3000, 2000]"}, {"/sensor/pixel_pitch_um", "1"}});
  Plan plan = make_plan(scene);
  learn_density(plan, {}, 2);
  EXPECT_LE(plan.density.paths.size(), std::size_t{1} << 14);
  EXPECT_GT(plan.density.paths.size(), std::size_t{1} << 13);
}

double relative_variance(const Film& film) {
  double mean = 0;
  for (int k = 0; k < 3; ++k) mean += film.average(k).mean / 3;
  double sum = 0;
  const auto pixels = static_cast<std::size_t>(film.width()) * static_cast<std::size_t>(film.height());
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    for (int k = 0; k < 3; ++k)
      sum += film.variance(pixel, k) / (std::pow(film.mean(pixel, k), 2) + 0.01 * mean * mean);
  return sum / (3 * static_cast<double>(pixels));
}

// At as many rays, by the films' own variances, where pilots expect to gain.
TEST(AdaptiveRender, HasLessErrorForItsRays) {
  for (const char* name : {"cornell.json", "materials/rough_metal.json"}) {
    if (!test::nightly() && std::string(name) != "cornell.json") continue;
    const Scene scene =
        test::load(name, {{"/sensor/resolution", "[128, 96]"}, {"/render/integrator", "path"}});
    RenderOptions options;
    options.time_limit_s = 1e9;
    options.samples = SampleRange{0, 8};
    const double rays_of_eight = static_cast<double>(render(scene, options).stats.rays);
    options.adaptive = true;
    options.samples = SampleRange{0, test::nightly() ? 48U : 16U};
    const RenderResult adaptive = render(scene, options);
    options.adaptive = false;
    const double eights = static_cast<double>(adaptive.stats.rays) / rays_of_eight;
    options.samples = SampleRange{0, 8 * static_cast<std::uint64_t>(std::lround(eights))};
    const RenderResult alike = render(scene, options);
    const double gain = relative_variance(alike.film) * static_cast<double>(alike.stats.rays) /
                        (relative_variance(adaptive.film) * static_cast<double>(adaptive.stats.rays));
    std::printf("%s: %.2f\n", name, gain);
    EXPECT_GT(gain, 1.05) << name;
  }
}

// What is sought by chance is not biased: over many seeds its mean is that of paths spread alike.
TEST(AdaptiveRender, HasTheSameMean) {
  Scene scene = small({{"/sensor/resolution", "[32, 32]"}});
  RenderOptions options;
  options.time_limit_s = 1e9;
  options.samples = SampleRange{0, 8};
  options.adaptive = true;
  const int seeds = test::nightly() ? 128 : 24;
  std::vector<double> sums(16, 0.0);
  std::vector<double> squares(16, 0.0);
  for (int seed = 1; seed <= seeds; ++seed) {
    scene.render.seed = static_cast<std::uint64_t>(seed);
    const Film film = render(scene, options).film;
    for (int i = 0; i < 16; ++i) {
      const double mean = film.average(1, i % 4 * 8, i / 4 * 8, i % 4 * 8 + 8, i / 4 * 8 + 8).mean;
      sums[static_cast<std::size_t>(i)] += mean / seeds;
      squares[static_cast<std::size_t>(i)] += mean * mean / seeds;
    }
  }
  scene.render.seed = 1000;
  scene.render.samples = test::nightly() ? 4096 : 512;
  const Film alike = render(scene, {}).film;
  for (int i = 0; i < 16; ++i) {
    const Film::Average reference = alike.average(1, i % 4 * 8, i / 4 * 8, i % 4 * 8 + 8, i / 4 * 8 + 8);
    const auto region = static_cast<std::size_t>(i);
    const double variance = (squares[region] - sums[region] * sums[region]) / (seeds - 1);
    const double error = std::hypot(std::sqrt(variance), reference.standard_error);
    EXPECT_LT(std::abs(sums[region] - reference.mean), 5.5 * error) << i;
    if (test::nightly())
      EXPECT_NEAR(sums[region], reference.mean, 0.02 * reference.mean) << i;
    else
      EXPECT_LT(error, 0.02 * reference.mean) << i;
  }
}

TEST(AdaptiveRender, GoesOnAsItWouldHaveOnAnyNumberOfThreads) {
  const Scene scene = small({{"/sensor/resolution", "[64, 64]"}});
  RenderOptions options;
  options.adaptive = true;
  options.samples = SampleRange{0, 24};
  options.threads = 1;
  const RenderResult whole = render(scene, options);
  options.threads = 3;
  options.samples = SampleRange{0, 7};
  RenderResult part = render(scene, options);
  options.samples = SampleRange{0, 24};
  const RenderResult end = render(scene, options, std::move(part));
  EXPECT_EQ(end.film.bytes(), whole.film.bytes());
  EXPECT_EQ(end.stats.paths, whole.stats.paths);
  EXPECT_GT(whole.stats.paths, 24U * 64 * 64);
  options.adaptive = false;
  EXPECT_NE(render(scene, options).film.bytes(), whole.film.bytes());
}

}  // namespace
}  // namespace abbe

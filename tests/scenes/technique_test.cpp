#include "tests/scenes/margin.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"
#include "transport/render/pass.h"

namespace abbe {
namespace {

// A lamp so big over a glass ball that path tracing makes its caustic with little noise too: each technique
// can be held against the other.
const std::vector<Override> kBigLamp{{"/sensor/resolution", "[64, 64]"}, {"/lights/0/sphere/radius", "1.2"}};

RenderResult render_with(const char* integrator, int samples, std::vector<Override> settings,
                         bool force_light_tracing = false) {
  settings.push_back({"/render/integrator", integrator});
  settings.push_back({"/render/samples", std::to_string(samples)});
  Scene scene = test::load("glass_sphere.json", settings);
  if (force_light_tracing) {
    scene.features.light_tracing = true;
    scene.features.light_is_traced[0] = true;
  }
  return render(scene, {});
}

TEST(Techniques, SharingPathsLosesAndDoublesNothing) {
  const int samples = test::nightly() ? 256 : 16;
  const RenderResult alone = render_with("path", 4 * samples, kBigLamp);
  const RenderResult shared = render_with("auto", samples, kBigLamp, true);
  EXPECT_GT(shared.stats.paths, static_cast<std::uint64_t>(samples) * 64 * 64) << "no photon was traced";
  const test::Comparison c = test::compare_regions(alone.film, shared.film, 4);
  EXPECT_LT(c.largest_z, test::kLargestZ);
  EXPECT_NEAR(c.ratio, 1, test::ratio_margin(alone.film, shared.film, 0.003, 0.08));
}

// However many photons and camera paths samples have, they stand for the same light; over any of them, so
// that a range need not hold each pixel's camera paths equally often.
TEST(Techniques, TheirSharesChangeNoiseOnly) {
  Scene scene = test::load("glass_sphere.json",
                           {{"/sensor/resolution", "[48, 48]"}, {"/lights/0/sphere/radius", "0.8"}});
  scene.features.light_tracing = true;
  scene.features.light_is_traced[0] = true;
  const std::uint64_t samples = 8 * (test::nightly() ? 240 : 30);
  const auto film_with = [&scene, samples](std::uint64_t photons, std::uint32_t path_interval) {
    Plan plan = make_plan(scene);
    plan.photons = photons;
    plan.path_interval = path_interval;
    Film film(48, 48, 3, 8, plan.nominal_value, photons, path_interval);
    Pass(plan, film, {}, {0, samples}, 0, path_interval).run(2, [] { return false; });
    film.set_samples(count_per_replicate({{0, samples}}, 8));
    EXPECT_EQ(film.shape().photons, photons);
    EXPECT_EQ(film.shape().path_interval, path_interval);
    return film;
  };
  const Film whole = film_with(48 * 48, 1);
  for (const Film& other : {film_with(48 * 48 / 8, 2), film_with(48 * 48, 8)}) {
    const test::Comparison c = test::compare_regions(whole, other, 4);
    EXPECT_LT(c.largest_z, test::kLargestZ);
    EXPECT_NEAR(c.ratio, 1, test::ratio_margin(whole, other, 0.01, 0.08));
  }
}

TEST(Techniques, RouletteChangesNoiseOnly) {
  std::vector<Override> without = kBigLamp;
  without.push_back({"/render/roulette_depth", "-1"});
  const int samples = test::nightly() ? 256 : 48;
  const RenderResult a = render_with("path", samples, kBigLamp);
  const RenderResult b = render_with("path", samples, without);
  EXPECT_LT(test::compare_regions(a.film, b.film, 4).largest_z, test::kLargestZ);
}

TEST(Techniques, LightTracingAloneMakesADiffuseSceneToo) {
  const std::vector<Override> small{{"/sensor/resolution", "[48, 48]"},
                                    {"/render/samples", test::nightly() ? "4096" : "192"}};
  std::vector<Override> light = small;
  light.push_back({"/render/integrator", "light"});
  const RenderResult a = render(test::load("cornell.json", small), {});
  const RenderResult b = render(test::load("cornell.json", light), {});
  // All but the directly visible lamp, which no photon that scatters can show: the lower three quarters of
  // the picture.
  for (int channel = 0; channel < 3; ++channel)
    for (int i = 0; i < 4; ++i) {
      const test::Region ra = test::region(a.film, channel, 12 * i, 12, 12 * i + 12, 48);
      const test::Region rb = test::region(b.film, channel, 12 * i, 12, 12 * i + 12, 48);
      EXPECT_LT(std::abs(ra.mean - rb.mean), test::kLargestZ * std::sqrt(ra.variance + rb.variance))
          << channel << ' ' << i;
      EXPECT_NEAR(rb.mean / ra.mean, 1, test::ratio_margin(ra, rb, 0.03, 0.2));
    }
}

}  // namespace
}  // namespace abbe

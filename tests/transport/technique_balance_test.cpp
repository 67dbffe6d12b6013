#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/tier.h"
#include "transport/render/technique_balance.h"
#include "transport/render/trained_plan.h"

namespace abbe {
namespace {

constexpr std::uint64_t kPixels = 32 * 32;

// A card seen from in front, a ball of glass and a lamp; what photons bring comes through the ball.
Scene card_with(const Imath::V3d& ball, const Imath::V3f& lamp) {
  Scene scene{};
  scene.camera = {Pinhole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, 0.005}, 32, 32, 0.001};
  scene.materials = {{"card", DiffuseMaterial{Curve(0.5)}},
                     {"glass", DielectricMaterial{"glass", RefractiveIndex(1.5)}}};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"card", Quad{{-5, -5, 5}, {0, 10, 0}, {10, 0, 0}}, 0});
  scene.shapes.push_back({"ball", Sphere{ball, 0.3}, 1});
  scene.lights.push_back({"lamp", PointLight{lamp}, Curve(1.0)});
  scene.commit();
  return scene;
}

// Photons, and the interval of camera paths.
using Shares = std::pair<std::uint64_t, std::uint32_t>;
Shares shares(const Scene& scene, int threads = 2) {
  Plan plan = make_trained_plan(scene, threads);
  balance_techniques(plan, threads);
  return {plan.photons, plan.path_interval};
}

TEST(TechniqueShares, GoWhereTheErrorIs) {
  EXPECT_EQ(shares(card_with({0, 0, 2}, {0, 0, 2})), Shares(kPixels, 8))
      << "all light comes through the ball";
  EXPECT_EQ(shares(card_with({0, 0, -20}, {0, 0, 1})), Shares(kPixels / 8, 1))
      << "the ball is behind the camera";
}

TEST(TechniqueShares, AreTheSameOnAnyNumberOfThreads) {
  const Scene scene = card_with({0.6, 0, 3}, {-1, 0, 0.5});
  EXPECT_EQ(shares(scene, 1), shares(scene, 3));
}

TEST(TechniqueShares, AreWholeWhereThereIsNoChoice) {
  Scene scene = card_with({0, 0, 2}, {0, 0, 2});
  scene.render.integrator = Integrator::path;
  EXPECT_EQ(shares(scene), Shares(kPixels, 1));
  scene.render.integrator = Integrator::light;
  EXPECT_EQ(shares(scene), Shares(kPixels, 1));
}

// What paths of a pixel share is no variance: those that see the sky alone find the same in every direction
// and, of a spectrum and a channel without wavelength, by every wavelength.
TEST(TechniqueShares, PathsThatAllFindTheSameHaveNoVariance) {
  Scene scene = card_with({0, 0, -20}, {0, 0, -1});
  scene.shapes.erase(scene.shapes.begin());
  scene.lights.push_back({"sky", EnvironmentLight{}, Curve(1.0)});
  scene.commit();
  const TechniqueStatistics found = measure_techniques(make_plan(scene), 2, 256);
  EXPECT_NEAR(found.path_square, kPixels / 1.01, 0.01 * kPixels) << "over the mean's square and a hundredth";
  EXPECT_LT(found.path_variance, 1e-3 * kPixels) << "how a pixel's middle and edges see the sky";
}

// The variance of a path is that of the light, on a film of one pixel as of many that see the same. By day of
// the smallest and the oddest.
TEST(TechniqueShares, TellTheVarianceOfAPathOnFilmsOfAnySize) {
  const auto variance = [](int width, int height) {
    Scene scene = card_with({0, 0, -20}, {0, 0, 1});
    scene.camera.width = width;
    scene.camera.height = height;
    scene.camera.pixel_pitch = 0.0001;
    scene.lights[0].emission = Curve({{400, 0}, {500, 1}, {600, 0}});
    Plan plan = make_trained_plan(scene, 2);
    const auto costs = balance_techniques(plan, 2);
    return costs ? costs->camera_paths.relative_variance : 0;
  };
  const double many = variance(32, 32);
  EXPECT_GT(many, 0);
  std::vector<std::pair<int, int>> sizes{{1, 1}, {17, 5}};
  if (test::nightly()) sizes.insert(sizes.end(), {{4, 4}, {64, 1}});
  for (const auto& [width, height] : sizes)
    EXPECT_NEAR(variance(width, height) / many, 1, 0.3) << width << " x " << height;
}

}  // namespace
}  // namespace abbe

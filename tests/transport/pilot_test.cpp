#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "transport/render/pass.h"
#include "transport/render/pilot.h"

namespace abbe {
namespace {

// A white card that fills the left half of the view, lit by a lamp at the camera.
Scene card_on_the_left(int width, int height) {
  Scene scene{};
  scene.camera = {Pinhole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, 0.005}, width, height, 0.01};
  scene.materials = {{"card", DiffuseMaterial{Curve(0.5)}}};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"card", Quad{{-5, -5, 5}, {0, 10, 0}, {5, 0, 0}}, 0});
  scene.lights.push_back({"lamp", PointLight{{0, 0, 0}}, Curve(1.0)});
  scene.commit();
  return scene;
}

TEST(Pilot, ShowsWhereLightIsWithoutTheSamplesOfAnyRender) {
  Scene scene = card_on_the_left(8, 4);
  const Film pilot = *pilot_film(make_plan(scene), 1);
  const bool left = pilot.mean(0, 0) > 0;
  for (std::size_t pixel = 0; pixel < 32; ++pixel)
    EXPECT_EQ(pilot.mean(pixel, 0) > 0, (pixel % 8 < 4) == left) << pixel;
  scene.render.seed = 12345;
  EXPECT_EQ(pilot_film(make_plan(scene), 2)->bytes(), pilot.bytes()) << "threads or the scene's seed matter";
  Film rendered(pilot.shape());
  Pass(make_plan(scene), rendered, {}, {0, 16}, 0, scene.render.seed).run(1, [] { return false; });
  EXPECT_NE(rendered.bytes(), pilot.bytes()) << "the pilot has the render's samples";
}

TEST(Pilot, IsEndedByAStop) {
  Scene scene = card_on_the_left(64, 64);
  EXPECT_FALSE(pilot_film(make_plan(scene), 1, {}, [] { return true; }));
  scene.render.samples = 16;
  std::atomic<bool> stop = false;
  const RelativeError whole = render(scene, {.measure_error = true, .stop = &stop}).stats.error;
  EXPECT_TRUE(std::isfinite(whole.median));
  stop = true;
  const RelativeError stopped = render(scene, {.measure_error = true, .stop = &stop}).stats.error;
  EXPECT_TRUE(std::isinf(stopped.median));
  EXPECT_EQ(stopped.frame_mean, whole.frame_mean);
}

TEST(Pilot, KeepsToTheCrop) {
  const Scene scene = card_on_the_left(8, 4);
  const Film pilot = *pilot_film(make_plan(scene), 1, Crop{0, 1, 8, 2});
  for (std::size_t pixel = 0; pixel < 32; ++pixel)
    EXPECT_TRUE(pixel / 8 == 1 || pilot.mean(pixel, 0) == 0) << pixel;
  EXPECT_GT(pilot.mean(8, 0) + pilot.mean(15, 0), 0);
}

// The numbers of the photons of each batch, each of which has found something.
std::vector<std::vector<float>> pilot_photons(const PilotPhotons& pilots, int threads) {
  return trace_pilot_photons(
      card_on_the_left(8, 4), pilots, threads, [](RayCaster&) { return 0; },
      [](int, std::span<const Sampler> photons) {
        std::vector<float> numbers;
        for (const Sampler& photon : photons) numbers.push_back(photon.group(0)[0]);
        return numbers;
      });
}

TEST(PilotPhotons, AreNoMoreThanEnough) {
  constexpr std::uint32_t kAtATime = 1U << 14;
  const auto photons = [](const auto& batches) { return batches.size() * kPilotPhotonBatch; };
  const auto all = pilot_photons({PilotStage::photon_guides, 3 * kAtATime}, 1);
  ASSERT_EQ(photons(all), 3 * kAtATime);
  EXPECT_NE(all[kAtATime / kPilotPhotonBatch], all.front());
  EXPECT_EQ(photons(pilot_photons({PilotStage::photon_guides, kPilotPhotonBatch}, 1)), kPilotPhotonBatch);
  EXPECT_EQ(photons(pilot_photons({PilotStage::photon_guides, 3 * kAtATime, 1}, 1)), kAtATime / 8);
  const auto two = pilot_photons({PilotStage::photon_guides, 3 * kAtATime, kAtATime + 1}, 3);
  ASSERT_EQ(photons(two), 2 * kAtATime);
  EXPECT_TRUE(std::equal(two.begin(), two.end(), all.begin())) << "threads or how many there are matter";
  EXPECT_NE(pilot_photons({PilotStage::caustics, kPilotPhotonBatch}, 1).front(), all.front());
  const auto others =
      pilot_photons({.stage = PilotStage::photon_guides, .max_photons = kAtATime, .first = kAtATime}, 1);
  EXPECT_TRUE(std::equal(others.begin(), others.end(), all.begin() + kAtATime / kPilotPhotonBatch));
}

// Of matter that holds them long there are fewer, as many for any number of threads.
TEST(PilotPhotons, AreNoMoreThanTheirRaysAllow) {
  const Scene scene = card_on_the_left(8, 4);
  const auto batches = [&](int threads) {
    return trace_pilot_photons(
               scene, {.stage = PilotStage::photon_guides, .max_photons = 1U << 17, .max_rays = 100000},
               threads, [](RayCaster& caster) { return &caster; },
               [](RayCaster* caster, std::span<const Sampler> photons) {
                 for (std::size_t i = 0; i < photons.size(); ++i)
                   (void)caster->intersect(Ray{{0, 0, -1}, {0, 0, 1}});
                 return photons;
               })
        .size();
  };
  EXPECT_EQ(batches(1), 224U);
  EXPECT_EQ(batches(3), 224U);
}

}  // namespace
}  // namespace abbe

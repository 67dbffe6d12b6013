#include <atomic>
#include <cmath>

#include <gtest/gtest.h>

#include "transport/render/pass.h"
#include "transport/render/pilot.h"

namespace abbe {
namespace {

// A white card that fills the left half of the view, lit by a lamp at the camera.
Scene card(int width, int height) {
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
  Scene scene = card(8, 4);
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
  Scene scene = card(64, 64);
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
  const Scene scene = card(8, 4);
  const Film pilot = *pilot_film(make_plan(scene), 1, Crop{0, 1, 8, 2});
  for (std::size_t pixel = 0; pixel < 32; ++pixel)
    EXPECT_TRUE(pixel / 8 == 1 || pilot.mean(pixel, 0) == 0) << pixel;
  EXPECT_GT(pilot.mean(8, 0) + pilot.mean(15, 0), 0);
}

}  // namespace
}  // namespace abbe

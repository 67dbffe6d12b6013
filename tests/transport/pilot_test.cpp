#include <gtest/gtest.h>

#include "transport/render/pilot.h"

namespace abbe {
namespace {

// A white card that fills the left half of the view, lit by a lamp at the camera.
Scene card(int width, int height) {
  Scene scene{};
  scene.camera = {LensCamera{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.05, INFINITY, 0.005, true},
                  width, height, 0.01};
  scene.materials = {{"card", DiffuseMaterial{Curve(0.5)}}};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"card", Quad{{-5, -5, 5}, {0, 10, 0}, {5, 0, 0}}, 0});
  scene.lights.push_back({"lamp", PointLight{{0, 0, 0}}, Curve(1.0)});
  scene.commit();
  return scene;
}

TEST(Pilot, ShowsWhereLightIsWithoutTheSamplesOfAnyRender) {
  Scene scene = card(8, 4);
  const Film pilot = pilot_film(make_plan(scene), 1);
  const bool left = pilot.mean(0, 0) > 0;
  for (std::size_t pixel = 0; pixel < 32; ++pixel)
    EXPECT_EQ(pilot.mean(pixel, 0) > 0, (pixel % 8 < 4) == left) << pixel;
  scene.render.seed = 12345;
  EXPECT_EQ(pilot_film(make_plan(scene), 2).bytes(), pilot.bytes()) << "threads or the scene's seed matter";
  scene.render.samples = 16;
  const RenderResult rendered = render(scene, {});
  EXPECT_NE(rendered.film.mean(0, 0) + rendered.film.mean(7, 0), pilot.mean(0, 0) + pilot.mean(7, 0));
}

TEST(Pilot, KeepsToTheCrop) {
  const Scene scene = card(8, 4);
  const Film pilot = pilot_film(make_plan(scene), 1, Crop{0, 1, 8, 2});
  for (std::size_t pixel = 0; pixel < 32; ++pixel)
    EXPECT_TRUE(pixel / 8 == 1 || pilot.mean(pixel, 0) == 0) << pixel;
  EXPECT_GT(pilot.mean(8, 0) + pilot.mean(15, 0), 0);
}

}  // namespace
}  // namespace abbe

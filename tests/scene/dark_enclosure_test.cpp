#include <gtest/gtest.h>

#include "scene/lost_light.h"
#include "tests/scene/meshes.h"
#include "tests/scene/scenes.h"

namespace abbe {
namespace {

using Imath::V3d;

// A shell around the camera at the origin, and a light.
Scene shell(const Shape& shape, Material material, const V3d& lamp) {
  Scene scene{};
  scene.camera = test::pinhole();
  scene.materials = {std::move(material), test::diffuse()};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"shell", shape, 0});
  scene.shapes.push_back({"floor", Quad{{-9, -9, -3}, {18, 0, 0}, {0, 18, 0}}, 1});
  scene.lights.push_back({"lamp", PointLight{Imath::V3f(lamp)}, Curve(1.0)});
  scene.commit();
  return scene;
}

const Mesh& closed_box() {
  static const Mesh kBox = test::box({-1, -1, -1}, {1, 1, 1});
  return kBox;
}

const V3d kInside(0.2, 0.3, 0.1);
const V3d kOutside(0, 0, 4);

TEST(DarkEnclosure, IsOpaqueClosedAndWithoutALight) {
  const Sphere ball{{0, 0, 0}, 2};
  EXPECT_EQ(dark_enclosure(shell(ball, test::diffuse(), kOutside)), 0U);
  EXPECT_EQ(dark_enclosure(shell(ball, test::mirror(), kOutside)), 0U);
  EXPECT_EQ(dark_enclosure(shell(closed_box(), test::diffuse(), kOutside)), 0U);
  EXPECT_FALSE(dark_enclosure(shell(ball, test::diffuse(), kInside))) << "an integrating sphere";
  EXPECT_FALSE(dark_enclosure(shell(closed_box(), test::diffuse(), kInside))) << "a lit room";
  EXPECT_FALSE(dark_enclosure(shell(ball, test::glass(), kOutside)));
  EXPECT_FALSE(dark_enclosure(shell(test::inside_out(closed_box()), test::diffuse(), kOutside)))
      << "made to be seen from within";
  EXPECT_FALSE(dark_enclosure(shell(Sphere{{0, 0, 3}, 2}, test::diffuse(), kOutside))) << "beside the camera";
  EXPECT_FALSE(dark_enclosure(shell(Disc{{0, 0, 1}, {0, 0, 1}, 2}, test::diffuse(), kOutside)));
}

TEST(DarkEnclosure, HasNoOpening) {
  Mesh open = closed_box();
  open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 2);  // the wall at -x
  EXPECT_FALSE(dark_enclosure(shell(open, test::diffuse(), kOutside)));
}

TEST(DarkEnclosure, IsLitByALampThatReachesIntoIt) {
  Scene scene = shell(closed_box(), test::diffuse(), kOutside);
  scene.shapes.push_back({"tube", Quad{{0.5, 0, 0}, {8, 0, 0}, {0, 0.1, 0}}, 1});
  scene.lights.push_back({"tube", AreaLight{2, false}, Curve(1.0)});
  scene.commit();
  EXPECT_FALSE(dark_enclosure(scene));
}

TEST(DarkEnclosure, IsLitByWhatItEmitsInward) {
  for (const bool two_sided : {false, true}) {
    Scene scene = shell(Sphere{{0, 0, 0}, 2}, test::diffuse(), kOutside);
    scene.shapes[0].light = 1;
    scene.lights.push_back({"wall", AreaLight{0, two_sided}, Curve(1.0)});
    scene.commit();
    EXPECT_EQ(dark_enclosure(scene).has_value(), !two_sided);
  }
}

}  // namespace
}  // namespace abbe

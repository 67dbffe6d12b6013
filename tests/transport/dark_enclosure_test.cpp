#include <gtest/gtest.h>

#include "tests/scene/scenes.h"
#include "transport/path/dark_enclosure.h"

namespace abbe {
namespace {

using Imath::V3d;

// A shell around the camera, which stands at the origin, and a lamp.
Scene shell(const Shape& shape, Material material, const V3d& lamp) {
  Scene scene{};
  scene.camera = testing::pinhole();
  scene.materials = {std::move(material), testing::diffuse()};
  scene.channels = {energy_channel("all", Curve(1.0))};
  scene.shapes.push_back({"shell", shape, 0});
  scene.shapes.push_back({"floor", Quad{{-9, -9, -3}, {18, 0, 0}, {0, 18, 0}}, 1});
  scene.lights.push_back({"lamp", PointLight{Imath::V3f(lamp)}, Curve(1.0)});
  scene.commit();
  return scene;
}

// Of half a side, its faces seen from outside, or from inside.
Mesh box(double h, bool outward) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back({i & 1 ? h : -h, i & 2 ? h : -h, i & 4 ? h : -h});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  if (!outward)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

const V3d kInside(0.2, 0.3, 0.1);
const V3d kOutside(0, 0, 4);

TEST(DarkEnclosure, IsOpaqueClosedAndWithoutALight) {
  const Sphere ball{{0, 0, 0}, 2};
  EXPECT_EQ(dark_enclosure(shell(ball, testing::diffuse(), kOutside)), 0U);
  EXPECT_EQ(dark_enclosure(shell(ball, testing::mirror(), kOutside)), 0U);
  EXPECT_EQ(dark_enclosure(shell(box(1, true), testing::diffuse(), kOutside)), 0U);
  EXPECT_FALSE(dark_enclosure(shell(ball, testing::diffuse(), kInside))) << "an integrating sphere";
  EXPECT_FALSE(dark_enclosure(shell(box(1, true), testing::diffuse(), kInside))) << "a lit room";
  EXPECT_FALSE(dark_enclosure(shell(ball, testing::glass(), kOutside)));
  EXPECT_FALSE(dark_enclosure(shell(box(1, false), testing::diffuse(), kOutside)))
      << "made to be seen from within";
  EXPECT_FALSE(dark_enclosure(shell(Sphere{{0, 0, 3}, 2}, testing::diffuse(), kOutside)))
      << "beside the camera";
  EXPECT_FALSE(dark_enclosure(shell(Disc{{0, 0, 1}, {0, 0, 1}, 2}, testing::diffuse(), kOutside)));
}

TEST(DarkEnclosure, IsLitByWhatItEmitsInward) {
  for (const bool two_sided : {false, true}) {
    Scene scene = shell(Sphere{{0, 0, 0}, 2}, testing::diffuse(), kOutside);
    scene.shapes[0].light = 1;
    scene.lights.push_back({"wall", AreaLight{0, two_sided}, Curve(1.0)});
    scene.commit();
    EXPECT_EQ(dark_enclosure(scene).has_value(), !two_sided);
  }
}

}  // namespace
}  // namespace abbe

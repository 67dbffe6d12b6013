#include "scene/contact.h"

#include <gtest/gtest.h>

#include "floor_scenes.h"
#include "meshes.h"
#include "scene/faces.h"
#include "scene/shapes/placed.h"

namespace abbe::test {
namespace {

using Imath::V3d;

// Around where matter and walls cross or meet, and nowhere else.
TEST(Contact, FindsWhereMatterIsAtWalls) {
  const auto at_walls = [](const Shape& matter, const Shape& wall) {
    Scene scene = floor_scene();
    scene.shapes = {{"wall", wall, kDiffuse}, {"matter", matter, kGlass}};
    scene.commit();
    EXPECT_TRUE(scene.shapes[0].at_walls.isEmpty()) << "of the wall";
    return scene.shapes[1].at_walls;
  };
  const auto expect_near = [](const Imath::Box3f& box, const V3d& low, const V3d& high) {
    EXPECT_TRUE(box.min.equalWithAbsError(Imath::V3f(low), 1e-4F)) << box.min;
    EXPECT_TRUE(box.max.equalWithAbsError(Imath::V3f(high), 1e-4F)) << box.max;
  };
  const Mesh block = box({-1, -1, 0}, {1, 1, 1});
  const Quad table{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}};
  const Quad through{{0.5, -3, -3}, {0, 6, 0}, {0, 0, 6}};
  expect_near(at_walls(block, table), {-1, -1, 0}, {1, 1, 0});
  expect_near(at_walls(block, through), {0.5, -1, 0}, {0.5, 1, 1});
  expect_near(at_walls(Sphere{{0, 0, 0.5}, 1}, table), {-1, -1, 0}, {1, 1, 0});
  expect_near(at_walls(block, Sphere{{0, 0, 1}, 0.5}), {-0.5, -0.5, 0.5}, {0.5, 0.5, 1});
  EXPECT_TRUE(at_walls(Sphere{{0, 0, 1.001}, 1}, table).isEmpty());
  EXPECT_TRUE(at_walls(block, box({-3, -3, -1}, {3, 3, 2})).isEmpty()) << "in a room";
  const Quad slanted{{-3, -3, -3}, {6, 0, 0}, {0, 6, 6}};
  EXPECT_FALSE(at_walls(block, slanted).isEmpty());
  EXPECT_TRUE(at_walls(Sphere{{0, -1, 1.2}, 1}, slanted).isEmpty()) << "above it, in its box";
}

TEST(FaceFinder, FindsAllThatMeetABox) {
  Random random(7);
  Mesh mesh;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const V3d at = random.in_cube(1) + V3d(2e-3 * i, 0, 0);  // those that follow each other are near
    for (int corner = 0; corner < 3; ++corner) mesh.vertices.push_back(at + random.in_cube(0.1));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Imath::M44d turned = Imath::M44d().setAxisAngle(V3d(1, 2, 3).normalized(), 0.6);
  const Shape plain = mesh;
  const Shape placed = PlacedShape{make_prototype(mesh), std::make_shared<Placement>(placement(turned))};
  FaceFinder finder;
  for (int i = 0; i < 100; ++i) {
    Imath::Box3d box(random.in_cube(2));
    box.extendBy(box.min + random.in_cube(0.3));
    for (const auto& [shape, to_world] : {std::pair(&plain, Imath::M44d()), std::pair(&placed, turned)}) {
      std::size_t expected = 0;
      for (const auto& triangle : mesh.triangles) {
        Imath::Box3d around;
        for (const std::uint32_t vertex : triangle) around.extendBy(mesh.vertices[vertex] * to_world);
        expected += around.intersects(box);
      }
      EXPECT_EQ(finder.near(*shape, box).size(), expected);
    }
  }
}

}  // namespace
}  // namespace abbe::test

#include "scene/coincident_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "floor_scenes.h"
#include "meshes.h"

namespace abbe::test {
namespace {

using Imath::M44d;
using Imath::V3d;

Scene scene_of_glass(const std::vector<Shape>& shapes) {
  Scene scene = floor_scene();
  scene.shapes.clear();
  for (const Shape& shape : shapes) scene.shapes.push_back({"glass", shape, kGlass});
  scene.commit();
  return scene;
}
Shape sliding(PlainShape shape, const V3d& by) {
  Placement at = placement(M44d());
  at.motion = std::make_shared<Motion>(
      std::vector<Motion::Keyframe>{{0, {0, 0, 0}, 0, {0, 0, 0}}, {1, {0, 0, 0}, 0, by}});
  return PlacedShape{make_prototype(std::move(shape)), std::make_shared<Placement>(at)};
}
M44d turn() {
  return M44d().setAxisAngle(V3d(1, 2, 3).normalized(), 0.6);
}

// Along all hits of a ray: the coincident surfaces with and without the regions are the same. Returns how
// often more than one surface was hit.
int compare_along(const Scene& anywhere, const Scene& there, const Ray& from) {
  int together = 0;
  Ray ray = from;
  for (int i = 0; i < 20; ++i) {
    const std::optional<SurfaceHit> hit = anywhere.intersect(ray);
    if (!hit) break;
    const CoincidentHits all = anywhere.coincident(ray, *hit);
    const CoincidentHits found = there.coincident(ray, *hit);
    EXPECT_EQ(found.count, all.count) << "at " << hit->point << " of " << hit->shape;
    for (std::size_t k = 0; k < std::min(found.count, all.count); ++k)
      EXPECT_EQ(found.at[k].shape, all.at[k].shape);
    if (all.count > 1) ++together;
    ray = spawn(*hit, ray.direction, ray.time);
  }
  return together;
}

// Casts rays to points at most `around` from the given ones and returns the number of coincident surfaces.
int touches(const std::vector<Shape>& shapes, const std::vector<V3d>& places, double around) {
  Scene anywhere = scene_of_glass(shapes);
  Scene there = anywhere;
  const std::vector<Imath::Box3f> regions = coincidence_regions(there);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    anywhere.shapes[i].coincidence_bounds.reset();
    there.shapes[i].coincidence_bounds = regions[i];
  }
  Random random(11);
  int together = 0;
  for (const V3d& place : places)
    for (int i = 0; i < 400 && !testing::Test::HasFailure(); ++i) {
      const Imath::V3f direction(random.direction());
      const Imath::V3f at(place + random.in_cube(around * std::pow(0.1, random.between(0, 6))));
      Ray ray = ray_at(at - direction * 3.0F, direction, random.uniform());
      together += compare_along(anywhere, there, ray);
    }
  return together;
}

TEST(TouchingRegions, LoseNothingThatTouches) {
  const Mesh block = box({-1, -1, 0}, {1, 1, 1});
  const Quad table{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}};
  const V3d middle(0.2, 0.3, 0);
  EXPECT_GT(touches({block, table}, {middle, {1, 0.3, 0}, {1, 1, 0}}, 1), 200) << "on a table";
  EXPECT_GT(touches({block, box({0.9, -2, -1}, {2, 2, 0})}, {{0.95, 0, 0}}, 0.1), 100) << "by an edge";
  EXPECT_GT(touches({block, box({1, 0.5, 0.5}, {2, 2, 2})}, {{1, 0.75, 0.75}}, 0.3), 100) << "by a side";
  EXPECT_GT(touches({block, box({1 + 2e-7, -1, 0}, {2, 1, 1})}, {{1, 0, 0.5}}, 0.5), 100) << "in rounding";
  EXPECT_GT(touches({Sphere{{0, 0, 1}, 1}, table}, {{0, 0, 0}}, 1e-3), 20) << "a ball";
  EXPECT_GT(touches({Sphere{{3, 2, 1}, 1}, Sphere{{3, 2, 0.5}, 0.5}}, {{3, 2, 0}}, 1e-3), 20) << "in it";
  EXPECT_GT(touches({Sphere{{3, 2, 1}, 1}, Sphere{{3, 2, -1}, 1}}, {{3, 2, 0}}, 1e-3), 20) << "beside it";
  EXPECT_GT(touches({Sphere{{0, 0, 1}, 1}, Sphere{{0, 0, 1}, 1}}, {{0, 0, 2}}, 1), 200) << "twice";
  EXPECT_GT(touches({placed(block, turn()), placed(table, turn())}, {middle * turn()}, 1), 200) << "turned";
  EXPECT_GT(touches({placed(Sphere{{0, 0, 1}, 1}, M44d().setScale(V3d(2, 1, 1))), table}, {{0, 0, 0}}, 1e-3),
            20)
      << "an ellipsoid";
  EXPECT_GT(touches({sliding(block, {2.5, 0, 0}), table}, {{3, 0, 0}}, 0.4), 50) << "where it slides to";
}

TEST(TouchingRegions, HoldWhatCrossesAtSmallAngles) {
  const Quad table{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}};
  const Quad leaning{{-1, -1, -0.02}, {2, 0, 0.04}, {0, 2, 0}};
  EXPECT_GT(touches({leaning, table}, {{0, 0, 0}, {0, 0.9, 0}}, 1e-3), 20);
  const double height = 0.9997;  // of its radius: the plane cuts off a cap whose rim is tilted by 1.4 degrees
  const double rim = std::sqrt(1 - height * height);
  EXPECT_GT(touches({Sphere{{0, 0, height}, 1}, table}, {{rim, 0, 0}, {0, -rim, 0}}, 1e-3), 20);
  const double half = 0.01;  // half the distance between two balls of equal size
  const double ring = std::sqrt(1 - half * half);
  EXPECT_GT(touches({Sphere{{0, 0, -half}, 1}, Sphere{{0, 0, half}, 1}}, {{ring, 0, 0}}, 1e-3), 20);
}

TEST(TouchingRegions, HoldThinBodies) {
  EXPECT_GT(touches({box({-1, -1, 0}, {1, 1, 2e-7})}, {{0, 0, 0}}, 0.5), 100);
}

// The box around the region where shapes coincide; empty if they do not.
TEST(TouchingRegions, AreWhereTheyTouchAlone) {
  const auto regions = [](const std::vector<Shape>& shapes) {
    const Scene scene = scene_of_glass(shapes);
    return coincidence_regions(scene);
  };
  const auto expect_near = [](const Imath::Box3f& at, const V3d& low, const V3d& high) {
    EXPECT_TRUE(at.min.equalWithAbsError(Imath::V3f(low), 1e-4F)) << at.min;
    EXPECT_TRUE(at.max.equalWithAbsError(Imath::V3f(high), 1e-4F)) << at.max;
  };
  const Mesh block = box({-1, -1, 0}, {1, 1, 1});
  const Quad table{{-3, -3, 0}, {6, 0, 0}, {0, 6, 0}};
  const auto on_table = regions({block, table});
  expect_near(on_table[0], {-1, -1, 0}, {1, 1, 0});
  expect_near(on_table[1], {-1, -1, 0}, {1, 1, 0});
  expect_near(regions({Sphere{{0, 0, 1}, 1}, table})[1], {-1, -1, 0}, {1, 1, 0});
  for (const auto& shapes : std::vector<std::vector<Shape>>{
           {block, box({-3, -3, -1}, {3, 3, 2})},
           {block, Sphere{{0, 0, 0.5}, 0.3}},
           {block, Sphere{{0, 0, 1}, 0.3}},
           {Sphere{{0, 0, 1}, 1}, Sphere{{0, 0, 1.1}, 0.5}},
           {Sphere{{0, 0, 1}, 1}, Sphere{{0, 1, 1}, 1}},
           {block, Quad{{0.5, -3, -3}, {0, 6, 0}, {0, 0, 6}}, Quad{{-3, -3, -3}, {6, 0, 0}, {0, 6, 6}}}})
    for (const Imath::Box3f& at : regions(shapes)) EXPECT_TRUE(at.isEmpty()) << at.min << at.max;
}

// The overlap of the boxes, if comparing all faces would take long.
TEST(TouchingRegions, OfManyFacesAreTheirBoxes) {
  const Mesh ball = icosphere(7, false);  // with 327,680 triangles
  const Scene scene = scene_of_glass({ball, Quad{{-3, -3, 0.5}, {6, 0, 0}, {0, 6, 0}}});
  const std::vector<Imath::Box3f> regions = coincidence_regions(scene);
  EXPECT_TRUE(regions[0].intersects(Imath::V3f(0, 0, 1)));
  EXPECT_TRUE(regions[0].intersects(Imath::V3f(0, 0, -1)));
}

// In a column of so many shapes that each one is above all others.
TEST(TouchingRegions, OfManyShapesAreTheirBoxes) {
  std::vector<Shape> column;
  for (int i = 0; i < 12'000; ++i) column.push_back(Quad{{0, 0, 0.01 * i}, {1, 0, 0}, {0, 1, 0}});
  Scene scene = floor_scene();
  scene.shapes.clear();
  for (const Shape& shape : column) scene.shapes.push_back({"card", shape, kDiffuse});
  scene.commit();
  const std::vector<Imath::Box3f> regions = coincidence_regions(scene);
  for (const std::size_t i : {0U, 5'000U, 11'999U})
    EXPECT_TRUE(regions[i].intersects(Imath::V3f(0.5F, 0.5F, 0.01F * static_cast<float>(i)))) << i;
}

// If media cannot be nested, the regions are not computed.
TEST(TouchingRegions, AreLookedForWhereMatterIsNested) {
  const Mesh block = box({-1, -1, 0}, {1, 1, 1});
  EXPECT_TRUE(scene_of_glass({block, Sphere{{0, 0, 0.5}, 0.3}}).shapes[0].coincidence_bounds.has_value());
  Scene apart = scene_of_glass({block, Sphere{{0, 0, 5}, 0.3}});
  EXPECT_FALSE(apart.shapes[0].coincidence_bounds.has_value());
  std::get<Sphere>(apart.shapes[1].shape).center.z = 0.5;
  apart.commit();
  EXPECT_TRUE(apart.shapes[0].coincidence_bounds.has_value());
  std::get<Sphere>(apart.shapes[1].shape).center.z = 5;
  apart.commit();
  EXPECT_FALSE(apart.shapes[0].coincidence_bounds.has_value());
}

TEST(TouchingRegions, AreAllThatEmbreeIsAskedFor) {
  Scene scene = scene_of_glass({Sphere{{0, 0, 3}, 1}, Sphere{{0, 0, 3}, 1}});
  const Ray ray = ray_at({0, 0, 0}, {0, 0, 1}, 0);
  const std::optional<SurfaceHit> hit = scene.intersect(ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(scene.coincident(ray, *hit).count, 2U);
  for (ShapeInstance& shape : scene.shapes) shape.coincidence_bounds = Imath::Box3f();
  EXPECT_EQ(scene.coincident(ray, *hit).count, 1U);
}

}  // namespace
}  // namespace abbe::test

#include <gtest/gtest.h>

#include "scene/shapes/basic.h"
#include "scenes.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;

// On a ground twenty kilometres wide Embree resolves millimetres, and it confuses the halves on both sides of
// the diagonal.
TEST(LargeQuad, IsMetBesideItsDiagonalWhereTheRayCrossesIt) {
  test::Random random(3);
  const Scene scene = test::scene_of({Quad{{-1e4, -1e4, 0}, {2e4, 0, 0}, {0, 2e4, 0}}});
  double furthest = 0;
  for (int i = 0; i < 20000; ++i) {
    const V3d target(random.between(-0.003, 0.003), random.between(-0.003, 0.003), 0);
    const V3f origin(target + V3d(random.between(-0.02, 0.02), random.between(-0.02, 0.02), 0.02));
    const V3d way = target - V3d(origin);
    const auto hit = scene.intersect({origin, V3f(way.normalized())});
    ASSERT_TRUE(hit) << target;
    furthest = std::max(furthest, (V3d(hit->point) - target).length());
  }
  EXPECT_LT(furthest, 2e-8);
}

// Points stay off the edges themselves.
TEST(LargeQuad, PointsKeepOffItsEdges) {
  test::Random random(4);
  const Scene scene = test::scene_of({Quad{{1, 1, 0}, {2, 0, 0}, {0, 4, 0}}});
  for (int i = 0; i < 1000; ++i) {
    const V3f target(1, static_cast<float>(random.between(1.1, 4.9)), 0);
    const auto hit = scene.intersect({target + V3f(0, 0, 1), V3f(0, 0, -1)});
    ASSERT_TRUE(hit) << target;
    EXPECT_GT(hit->point.x, 1);
  }
}

}  // namespace
}  // namespace abbe

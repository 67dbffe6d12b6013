#include "scene/shapes/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "scene/shapes/shape.h"
#include "scene/shutter.h"
#include "tests/scene/meshes.h"
#include "tests/scene/scenes.h"

namespace abbe {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Imath::V3d applied(const Imath::M44d& map, const Imath::V3d& point) {
  return point * map;
}

double apart(const Imath::V3d& a, const Imath::V3d& b) {
  return (a - b).length();
}

TEST(Motion, TurnsAboutOneAxisByTheWholeAngle) {
  const Motion wheel({{0, {0, 0, 1}, 0, {1, 0, 0}}, {1, {0, 0, 1}, 2.5 * kTurn, {3, 0, 0}}});
  for (const double t : {0.0, 0.1, 0.37, 0.5, 0.99}) {
    const double angle = 2.5 * kTurn * t;
    EXPECT_LT(apart(applied(wheel.pose(t), {1, 0, 0}), {1 + 2 * t + std::cos(angle), std::sin(angle), 0}),
              1e-13)
        << t;
  }
  const Motion back({{0, {0, 0, -1}, -1.0, {0, 0, 0}}, {1, {0, 0, 1}, 3.0, {0, 0, 0}}});
  EXPECT_LT(apart(applied(back.pose(0.5), {1, 0, 0}), {std::cos(2.0), std::sin(2.0), 0}), 1e-13);
}

// Slerp is the shortest rotation at a constant rate: the midpoint is equally far from both ends.
TEST(Motion, GoesTheShorterWayBetweenAxes) {
  const Motion turned({{0, {1, 0, 0}, 0.4, {0, 0, 0}}, {1, {0, 1, 0}, 0.9, {0, 0, 0}}});
  for (const double t : {0.0, 1.0})
    EXPECT_LT(apart(applied(turned.pose(t), {0.3, -0.2, 0.9}),
                    applied(Imath::M44d().setAxisAngle(t == 0 ? Imath::V3d(1, 0, 0) : Imath::V3d(0, 1, 0),
                                                       t == 0 ? 0.4 : 0.9),
                            {0.3, -0.2, 0.9})),
              1e-13);
  const auto angle = [&](double a, double b) {
    const Imath::M44d turn = rigid_inverse(turned.pose(a)) * turned.pose(b);
    return std::acos((turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2);
  };
  EXPECT_NEAR(angle(0, 0.5), angle(0.5, 1), 1e-12);
  EXPECT_NEAR(angle(0, 1), 2 * angle(0, 0.5), 1e-12);
}

TEST(Motion, StandsStillBeyondItsKeyframes) {
  const Motion motion({{0.25, {0, 0, 0}, 0, {0, 0, 0}}, {0.75, {0, 0, 0}, 0, {1, 0, 0}}});
  EXPECT_EQ(motion.pose(0), motion.pose(0.25));
  EXPECT_EQ(motion.pose(1), motion.pose(0.75));
  EXPECT_DOUBLE_EQ(motion.pose(0.5)[3][0], 0.5);
  EXPECT_FALSE(motion.is_static());
  EXPECT_TRUE(Motion({{-2, {0, 0, 0}, 0, {0, 0, 0}}, {-1, {0, 0, 0}, 0, {1, 0, 0}}}).is_static());
  EXPECT_TRUE(Motion({{1, {0, 0, 0}, 0, {0, 0, 0}}, {2, {0, 0, 0}, 0, {1, 0, 0}}}).is_static());
}

// The corners of a hull at many times of a slice. If they rotate, their extremes are between the steps of
// `sweep`.
TEST(Motion, SweepsABoxAroundAllPlaces) {
  Motion motion(
      {{0, {0, 0, 1}, 0, {0, 0, 0}}, {0.4, {0, 0, 1}, 3 * kTurn, {1, 2, 0}}, {1, {1, 0, 0}, 1, {5, 2, 1}}});
  motion.recentre({2, 1, 0});
  test::Random random(3);
  for (int slice = 0; slice < 16; ++slice) {
    const std::vector<Imath::V3d> corners{random.in_cube(2), random.in_cube(2)};
    const Imath::Box3d box = motion.sweep(corners, slice / 16.0, (slice + 1) / 16.0);
    for (int i = 0; i <= 2000; ++i) {
      const double t = (slice + i / 2000.0) / 16;
      for (const Imath::V3d& corner : corners)
        EXPECT_TRUE(box.intersects(applied(motion.since_opening(t), corner)))
            << "slice " << slice << " time " << t;
    }
    EXPECT_LT(box.size().length(), 40);
  }
}

std::shared_ptr<const Placement> moving(const Imath::M44d& opening, const Motion& motion) {
  Placement at = placement(opening * motion.pose(0));
  at.motion = std::make_shared<const Motion>(motion);
  return std::make_shared<const Placement>(at);
}

// A rotor of a blade, a ball and a disc that makes 20 turns next to static shapes.
Scene rotor() {
  Scene scene{};
  scene.camera = {Pinhole{}, 1, 1, 0.01};
  scene.materials = {{"card", DiffuseMaterial{Curve(0.9)}}};
  scene.channels = {energy_channel("all", Curve(1.0))};
  const Motion spin({{0, {0, 0, 1}, 0, {0.5, 0, 0}}, {1, {0, 0, 1}, 20 * kTurn, {-0.5, 0.2, 0}}});
  const auto add = [&](PlainShape shape, const Imath::V3d& at) {
    scene.shapes.push_back(
        {"part",
         PlacedShape{make_prototype(std::move(shape)), moving(Imath::M44d().setTranslation(at), spin)}, 0});
  };
  add(make_prism(60, 0.2, 1.6), {0, 1, 0});
  add(Sphere{{0, 0, 0}, 0.4}, {-1.2, 0, 0});
  add(Disc{{0, 0, 0}, {0.6, 0, 0.8}, 0.5}, {1.2, 0, 0.1});
  add(Quad{{-0.3, -0.3, 0}, {0.6, 0, 0}, {0, 0.6, 0.1}}, {0, -1.2, 0});
  scene.shapes.push_back({"ground", Quad{{-4, -4, -1}, {8, 0, 0}, {0, 8, 0}}, 0});
  scene.commit();
  return scene;
}

TEST(Motion, LosesNoHitOfAFastRotor) {
  const Scene scene = rotor();
  EXPECT_TRUE(scene.features.motion);
  test::Random random(11);
  constexpr std::size_t kRays = 40000;
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < kRays; ++i) {
    const Imath::V3d origin = random.direction() * 6;
    const Imath::V3d target = random.in_cube(1.8);
    rays.push_back(ray_at(Imath::V3f(origin), Imath::V3f((target - origin).normalized()), random.uniform()));
  }
  std::vector<std::optional<SurfaceHit>> hits(kRays);
  scene.intersect(rays, hits);
  int met = 0;
  int differing = 0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const Ray& ray = rays[i];
    const auto exact = intersect_exact(scene,
                                       {Imath::V3d(ray.origin), Imath::V3d(ray.direction),
                                        std::numeric_limits<double>::infinity(), ray.time},
                                       0);
    const auto alone = scene.intersect(ray);
    ASSERT_EQ(alone.has_value(), hits[i].has_value());
    if (alone) {
      ASSERT_EQ(alone->shape, hits[i]->shape);
      ASSERT_EQ(alone->point, hits[i]->point);
      ASSERT_EQ(alone->normal, hits[i]->normal);
    }
    EXPECT_EQ(scene.occluded(ray), alone.has_value());
    // Corners are stored in float, so that one ray in ten thousand passes on the other side of an edge.
    if (exact.has_value() != alone.has_value() || (exact && exact->shape != alone->shape)) {
      ++differing;
      continue;
    }
    if (!exact) continue;
    if (exact->shape < 4) ++met;
    EXPECT_NEAR(exact->hit.t, alone->t, 2e-5);
    EXPECT_LT(apart(exact->hit.normal, Imath::V3d(alone->normal)), 1e-4);
  }
  EXPECT_GT(met, 2000);
  EXPECT_LE(differing, 4);
}

// S of a shutter that opens, stays open and closes, at the fraction s of the exposure.
double trapezoid(double s) {
  return s < 0 || s >= 1 ? 0 : s < 0.25 ? s / 0.25 : s < 0.5 ? 1 : (1 - s) / 0.5;
}

TEST(Shutter, PassesItsIntegral) {
  const Shutter box;
  EXPECT_EQ(box.mean(), 1);
  EXPECT_EQ(box.sample(7, 0.25F), 0.25F);
  EXPECT_EQ(box.weight(7, 0.25F), 1);
  const Shutter shutter({{0, 0}, {0.25, 1}, {0.5, 1}, {1, 0}}, 0, 10);
  EXPECT_DOUBLE_EQ(shutter.mean(), 0.625);
  constexpr int kCount = 4096;
  double passed = 0;
  for (int i = 0; i < kCount; ++i) {
    const auto u = static_cast<float>((i + 0.5) / kCount);
    passed += static_cast<double>(shutter.weight(3, u)) / kCount;
    // Samples have the distribution function of S.
    const double t = static_cast<double>(shutter.sample(3, u));
    const double below = t < 0.25 ? t * t / 0.5 : t < 0.5 ? 0.125 + (t - 0.25) : 0.625 - (1 - t) * (1 - t);
    EXPECT_NEAR(below / 0.625, u, 1e-6);
  }
  EXPECT_NEAR(passed, 0.625, 1e-6);
  EXPECT_EQ(shutter.static_equivalent().weight(0, 0.9F), 0.625F);
}

TEST(Shutter, RollsFromRowToRow) {
  constexpr int kRows = 8;
  const Shutter rolling({{0, 0}, {0.25, 1}, {0.5, 1}, {1, 0}}, 0.5, kRows);
  EXPECT_DOUBLE_EQ(rolling.span(), 4.5);
  for (int row = 0; row < kRows; ++row) {
    double passed = 0;
    constexpr int kCount = 9000;
    for (int i = 0; i < kCount; ++i) {
      const double time = (i + 0.5) / kCount;
      const auto weight = static_cast<double>(rolling.weight(row, static_cast<float>(time)));
      EXPECT_NEAR(weight, 4.5 * trapezoid(time * 4.5 - 0.5 * row), 1e-5);
      passed += weight / kCount;
      const auto drawn = static_cast<double>(rolling.sample(row, static_cast<float>(time)));
      EXPECT_GT(trapezoid(drawn * 4.5 - 0.5 * row), 0);
    }
    EXPECT_NEAR(passed, rolling.mean(), 1e-5);
  }
}

}  // namespace
}  // namespace abbe

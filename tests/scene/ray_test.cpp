#include "scene/shapes/ray.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scenes.h"

namespace abbe {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The float next to x towards the ray's origin, or x itself if it is practically a float.
float expected_back(double x, double direction) {
  const auto nearest = static_cast<float>(x);
  const double past = static_cast<double>(nearest) - x;
  if (nearest == 0 || std::abs(past) <= 0x1p-44 * std::abs(x)) return nearest;
  if (direction > 0 && past > 0) return std::nextafter(nearest, -kInfinity);
  if (direction < 0 && past < 0) return std::nextafter(nearest, kInfinity);
  return nearest;
}

void expect_back(const Imath::V3d& point, const Imath::V3d& direction) {
  const Imath::V3f back = rounded_back(point, direction);
  for (unsigned i = 0; i < 3; ++i)
    ASSERT_EQ(back[i], expected_back(point[i], direction[i])) << point[i] << " along " << direction[i];
}

TEST(Ray, PointsAreRoundedToWhereItComesFrom) {
  test::Random random(4);
  for (const double size : {1e-30, 1e-3, 1.0, 1e6})
    for (int i = 0; i < 10'000; ++i) {
      const Imath::V3d point = random.in_cube(size);
      const Imath::V3d direction = random.direction();
      expect_back(point, direction);
      expect_back(Imath::V3d(Imath::V3f(point)), direction);
      expect_back(Imath::V3d(Imath::V3f(point)) * (1 + 0x1p-46), direction);
      expect_back({point.x, 0, -0.0}, {direction.x, direction.y, direction.z});
      expect_back(point, {0, -0.0, direction.z});
    }
}

TEST(Ray, WhatFloatsTakeForZeroStaysThere) {
  for (const double x : {1e-60, -1e-60})
    for (const double along : {1.0, -1.0}) expect_back({x, 1, 1}, {along, 0, 0});
}

}  // namespace
}  // namespace abbe

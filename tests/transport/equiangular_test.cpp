#include "transport/path/free_path.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace abbe {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Light spot(const Imath::V3f& position, const Imath::V3f& axis, double half_angle_rad) {
  const auto cap = static_cast<float>(2 * std::pow(std::sin(half_angle_rad / 2), 2));
  return {"spot", SpotLight{position, axis.normalized(), cap}, Curve(1.0)};
}

// The mean of 1/p over uniform numbers is the length of the range with p > 0, here the whole segment.
TEST(Equiangular, ItsDensityIsThatOfItsSamples) {
  const Light lamp{"lamp", PointLight{{1, 2, 0.5F}}, Curve(1.0)};
  for (const float length : {0.5F, 4.0F, 100.0F}) {
    const auto part = Equiangular::along(Ray{{0, 0, 0}, {0, 1, 0}}, length, lamp);
    ASSERT_TRUE(part);
    constexpr int kNumbers = 100000;
    double sum = 0;
    for (int i = 0; i < kNumbers; ++i)
      sum += 1 / part->pdf(part->sample((static_cast<float>(i) + 0.5F) / kNumbers));
    EXPECT_NEAR(sum / kNumbers, length, 1e-3 * length);
  }
}

TEST(Equiangular, LooksWhereTheLightIsSeenUnderTheSameAngle) {
  const Light lamp{"lamp", PointLight{{3, 1, 0}}, Curve(1.0)};
  const auto part = Equiangular::along(Ray{{0, 0, 0}, {1, 0, 0}}, 6, lamp);
  ASSERT_TRUE(part);
  EXPECT_FLOAT_EQ(part->sample(0.5F), 3);
  EXPECT_NEAR(part->sample(0), 0, 1e-5);
  const auto endless = Equiangular::along(Ray{{3, 0, 0}, {1, 0, 0}}, kInfinity, lamp);
  ASSERT_TRUE(endless);
  EXPECT_NEAR(endless->sample(0.5F), 1, 1e-6);  // 45 degrees of 90
  EXPECT_FLOAT_EQ(endless->pdf(0), 2 / std::numbers::pi_v<float>);
}

// For random rays and cones of up to 85 degrees, the range is the illuminated part of the ray.
TEST(Equiangular, IsWithinTheConeOfASpot) {
  std::mt19937 numbers(1);
  std::normal_distribution<float> normal;
  const auto vector = [&] { return Imath::V3f(normal(numbers), normal(numbers), normal(numbers)); };
  int parts = 0;
  for (int i = 0; i < 20000; ++i) {
    const double half_angle = std::exp(std::uniform_real_distribution<>(-5, 0.4)(numbers));
    const Light lamp = spot(vector(), vector(), half_angle);
    const auto& cone = std::get<SpotLight>(lamp.kind);
    const Ray ray{vector(), vector().normalized()};
    constexpr float kLength = 3;
    const auto part = Equiangular::along(ray, kLength, lamp);
    parts += part ? 1 : 0;
    for (int k = 0; k <= 300; ++k) {
      const float t = kLength * static_cast<float>(k) / 300;
      const Imath::V3d from_lamp =
          Imath::V3d(ray.origin) + Imath::V3d(ray.direction) * t - Imath::V3d(cone.position);
      const double angle =
          std::atan2(from_lamp.cross(Imath::V3d(cone.axis)).length(), from_lamp.dot(Imath::V3d(cone.axis)));
      if (std::abs(angle - half_angle) < 1e-3) continue;  // rounding decides at the edge
      ASSERT_EQ(part && part->pdf(t) > 0, angle < half_angle) << "ray " << i << " at " << t;
    }
  }
  EXPECT_GT(parts, 1000);
}

TEST(Equiangular, IsOfLampsAtPointsAlone) {
  const Ray ray{{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(Equiangular::along(ray, 1, {"sun", DirectionalLight{}, Curve(1.0)}));
  EXPECT_FALSE(Equiangular::along(ray, 1, spot({0, 1, 0}, {0, 1, 0}, 0.5)));
  // Rays through the light and rays from it.
  const Light lamp{"lamp", PointLight{{1, 0, 0}}, Curve(1.0)};
  const auto through = Equiangular::along(ray, 2, lamp);
  ASSERT_TRUE(through);
  EXPECT_TRUE(std::isfinite(through->pdf(1)));
  EXPECT_FALSE(Equiangular::along(Ray{{1, 0, 0}, {1, 0, 0}}, 2, lamp));
}

}  // namespace
}  // namespace abbe

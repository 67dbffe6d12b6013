#include "materials/interface/snell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/angles.h"
#include "tests/materials/index_of.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;

TEST(Snell, ReflectsAboutTheNormal) {
  const V3d n = V3d(1, 2, -2) / 3;
  const V3d wo = V3d(0.3, 0.8, 0.1).normalized();
  const V3d wi = reflect(wo, n);
  EXPECT_NEAR(wi.dot(n), wo.dot(n), 1e-15);
  EXPECT_NEAR((wi + wo).cross(n).length(), 0, 1e-15);
}

TEST(Snell, ObeysTheSineLawInThePlaneOfIncidence) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const V3d n = V3d(uniform(rng), uniform(rng), uniform(rng)).normalized();
    V3d wo = V3d(uniform(rng), uniform(rng), uniform(rng)).normalized();
    if (wo.dot(n) < 0) wo = -wo;
    const double eta = std::exp(uniform(rng));
    const auto wi = refract(wo, n, eta);
    const double sin_i = wo.cross(n).length();
    EXPECT_EQ(wi.has_value(), sin_i < eta);
    if (!wi) continue;
    EXPECT_NEAR(wi->length(), 1, 1e-13);
    EXPECT_LT(wi->dot(n), 0);
    EXPECT_NEAR((n.cross(*wi) * eta + n.cross(wo)).length(), 0, 1e-13);
  }
}

TEST(Snell, EqualIndicesChangeNoBit) {
  std::mt19937 rng(2);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 10000; ++i) {
    const V3f n = V3f(normal(rng), normal(rng), normal(rng)).normalized();
    V3f wo = V3f(normal(rng), normal(rng), normal(rng)).normalized();
    if (n.dot(wo) < 0) wo = -wo;
    ASSERT_EQ(refract(wo, n, 1.0F), std::optional(-wo));
    const double c = std::generate_canonical<double, 53>(rng);
    ASSERT_EQ(refracted_cosine(c, 1.0), c);
  }
  EXPECT_EQ(refracted_cosine(1e-30F, 1.0F), 1e-30F);
}

TEST(Snell, NearlyEqualIndicesHardlyBend) {
  for (const float delta : {-1e-6F, 1e-6F}) {
    const float eta = 1 + delta;
    for (const double angle : {0.1, 0.5, 1.0, 1.5}) {
      const V3f wo(static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle)));
      const auto wi = refract(wo, V3f(0, 0, 1), eta);
      const auto exact = refract(V3d(wo), V3d(0, 0, 1), double(eta));
      ASSERT_TRUE(wi && exact);
      EXPECT_LT(std::atan2(V3d(*wi).cross(*exact).length(), V3d(*wi).dot(*exact)), 1e-6);
    }
  }
}

TEST(Snell, CriticalAngles) {
  const double eta = 1 / 1.5;
  const double critical = std::asin(eta);
  EXPECT_NEAR(critical / kDegree, 41.8, 0.05);
  const auto at = [&](double angle) {
    return refract(V3d(std::sin(angle), 0, std::cos(angle)), V3d(0, 0, 1), eta);
  };
  EXPECT_TRUE(at(critical - 1e-12));
  EXPECT_FALSE(at(critical + 1e-12));
}

}  // namespace
}  // namespace abbe

#include "transport/plan/aim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sampling/sampler.h"

namespace abbe {
namespace {

const Light kPoint{"point", PointLight{{0, 0, 0}}, Curve(1.0)};
const EmissionPoint kOrigin{{0, 0, 0}, {0, 0, 0}, 1};

// Estimates the integral over directions of g by the aim's own samples and densities.
template <typename G>
double integral(const Aim& aim, G g) {
  constexpr std::uint32_t kCount = 1 << 17;
  double sum = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(1, Purpose::pilot, 0, 0, i).group(0);
    const AimedDirection d = aim.sample(kPoint, kOrigin, u[2], {u[0], u[1]}, 0);
    sum += g(d.wi) / static_cast<double>(d.pdf);
  }
  return sum / kCount;
}

double one(const Imath::V3f&) {
  return 1;
}
double towards_target(const Imath::V3f& w) {
  return w.x > 0.99F ? 1 : 0;
}

TEST(Aim, DensitiesCoverTheWholeSphereOnce) {
  EXPECT_NEAR(integral(Aim(), one), 4 * std::numbers::pi, 0.02);
  EXPECT_NEAR(integral(Aim({0, 0, 0}, {5, 0, 0}, 1), one), 4 * std::numbers::pi, 0.3);
}

TEST(Aim, TheTargetIsIntegratedPrecisely) {
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(Aim({0, 0, 0}, {5, 0, 0}, 1), towards_target), cap, cap * 0.01);
}

TEST(Aim, LearningMovesDensityAndKeepsTheIntegral) {
  Aim aim({0, 0, 0}, {5, 0, 0}, 1);
  std::vector<double> importance(Aim::kGrid, 0.0);
  const int hot = 128 * Aim::kCells + 40;
  importance[hot] = 1;
  aim.learn(importance, 1);
  int in_hot_cell = 0;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const auto u = Sampler(1, Purpose::pilot, 0, 0, i).group(0);
    const AimedDirection d = aim.sample(kPoint, kOrigin, u[2], {u[0], u[1]}, 0);
    in_hot_cell += d.cell == hot ? 1 : 0;
  }
  EXPECT_GT(in_hot_cell, 4096 * 0.95 * 0.9 / 9 * 0.8);
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(aim, towards_target), cap, cap * 0.05);
}

// Directions are rounded to float: seen from afar that is a part of a cell, and cells differ by any factor.
TEST(Aim, AFarTargetIsIntegratedPrecisely) {
  constexpr float kDistance = 3000;
  const Imath::V3f axis(0.48F, 0.6F, 0.64F);
  Aim aim({0, 0, 0}, axis * kDistance, 1);
  std::vector<double> importance(Aim::kGrid, 0.0);
  importance[128 * Aim::kCells + 40] = 1;
  aim.learn(importance, 0);
  const auto within = [&axis](const Imath::V3f& w) {
    return w.cross(axis).length() < 0.9F / kDistance ? 1.0 : 0.0;
  };
  const double circle = std::numbers::pi * 0.81 / (kDistance * kDistance);
  EXPECT_NEAR(integral(aim, within), circle, circle * 0.01);
}

TEST(Aim, AnEmitterReachingBeyondItsTargetIsStillDrawnByTheStatedDensity) {
  const Aim aim({0, 0, 0}, {5, 0, 0}, 1);
  const EmissionPoint beyond{{7, 0.5F, 0}, {0, 0, 0}, 1};
  double sum = 0;
  constexpr std::uint32_t kCount = 1 << 16;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(1, Purpose::pilot, 0, 0, i).group(0);
    const AimedDirection d = aim.sample(kPoint, beyond, u[2], {u[0], u[1]}, 0);
    sum += d.wi.x < -0.99F ? 1 / static_cast<double>(d.pdf) : 0;
  }
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(sum / kCount, cap, cap * 0.02);
}

// Its emission tells the cells that it learns from, and each cell is then drawn by the density it states.
TEST(Aim, ALightInsideItsTargetIsAimedOnceItHasLearnt) {
  EXPECT_TRUE(Aim({0, 0, 0}, {5, 0, 0}, 1).guided());
  Aim aim({0, 0, 0}, {0.5F, 0, 0}, 1);
  EXPECT_FALSE(aim.guided());
  std::vector<double> importance = aim.no_importance();
  ASSERT_EQ(importance.size(), static_cast<std::size_t>(Aim::kGrid));
  const Imath::V3f hot = Imath::V3f(0.48F, -0.6F, 0.64F);
  constexpr std::uint32_t kCount = 1 << 16;
  const auto direction = [&](std::uint32_t i) {
    const auto u = Sampler(1, Purpose::pilot, 0, 0, i).group(0);
    return aim.sample(kPoint, kOrigin, u[2], {u[0], u[1]}, 0);
  };
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const AimedDirection d = direction(i);
    EXPECT_FLOAT_EQ(d.pdf, 1 / (4 * std::numbers::pi_v<float>));
    ASSERT_GE(d.cell, 0);
    if (d.wi.dot(hot) > 0.99F) importance[static_cast<std::size_t>(d.cell)] += 1;
  }
  aim.learn(importance, 2);
  EXPECT_TRUE(aim.guided());
  int aimed = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) aimed += direction(i).wi.dot(hot) > 0.97F ? 1 : 0;
  EXPECT_GT(aimed, 0.8 * kCount);
  EXPECT_NEAR(integral(aim, one), 4 * std::numbers::pi, 0.3);
  const auto near_hot = [&](const Imath::V3f& w) { return w.dot(hot) > 0.995F ? 1.0 : 0.0; };
  EXPECT_NEAR(integral(aim, near_hot), 2 * std::numbers::pi * 0.005, 0.01 * 2 * std::numbers::pi * 0.005);
}

}  // namespace
}  // namespace abbe

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
  EXPECT_NEAR(integral(Aim({0, 0, 0}, 0, {5, 0, 0}, 1), one), 4 * std::numbers::pi, 0.3);
}

TEST(Aim, TheTargetIsIntegratedPrecisely) {
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(Aim({0, 0, 0}, 0, {5, 0, 0}, 1), towards_target), cap, cap * 0.01);
}

// So many rays from each of those places through another.
std::vector<ShownRay> rays_through(const Imath::V3f& place, const std::vector<Imath::V3f>& starts,
                                   std::size_t each) {
  std::vector<ShownRay> rays;
  for (const Imath::V3f& from : starts) rays.insert(rays.end(), each, {from, (place - from).normalized(), 1});
  return rays;
}

// Of all directions that an aim draws for a photon from there, the share that goes through a ball.
double share_through(const Aim& aim, const Imath::V3f& from, const Imath::V3f& center, float radius) {
  constexpr std::uint32_t kCount = 1 << 14;
  double through = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(3, Purpose::pilot, 0, 0, i).group(0);
    const AimedDirection d = aim.sample(kPoint, {from, {0, 0, 0}, 1}, u[2], {u[0], u[1]}, 0);
    through += (center - from).cross(d.wi).length() < radius && d.wi.dot(center - from) > 0 ? 1 : 0;
  }
  return through / kCount;
}

TEST(Aim, LearningMovesDensityAndKeepsTheIntegral) {
  Aim aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  const Imath::V3f hot(5, 0.3F, 0.2F);
  aim.learn(rays_through(hot, {{0, 0, 0}}, 4096));
  EXPECT_GT(share_through(aim, {0, 0, 0}, hot, 0.01F), 0.95 * 0.9 * 0.85);
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(aim, towards_target), cap, cap * 0.05);
}

// Most go one way and a few quite another: neither is left to what goes anywhere.
TEST(Aim, WhereFewGoIsAimedAtToo) {
  Aim aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  const Imath::V3f most(5, 0.3F, 0.2F);
  const Imath::V3f few(5, -0.6F, -0.4F);
  std::vector<ShownRay> rays = rays_through(most, {{0, 0, 0}}, 10000);
  for (const ShownRay& ray : rays_through(few, {{0, 0, 0}}, 50)) rays.push_back(ray);
  aim.learn(rays);
  EXPECT_GT(share_through(aim, {0, 0, 0}, most, 0.01F), 0.5);
  EXPECT_GT(share_through(aim, {0, 0, 0}, few, 0.3F), 0.08);
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(aim, towards_target), cap, cap * 0.05);
}

// Two rays that come close to each other do not tell how far around others go: at each distance some do, and
// half of them anywhere.
TEST(Aim, GuessesAroundFewAtAllDistances) {
  Aim aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  const double even = share_through(aim, {0, 0, 0}, {5, -0.6F, -0.4F}, 0.1F);
  const Imath::V3f few(5, 0.3F, 0.2F);
  std::vector<ShownRay> rays = rays_through(few, {{0, 0, 0}}, 1);
  rays.push_back(rays_through({5, 0.301F, 0.2F}, {{0, 0, 0}}, 1).front());
  aim.guess(rays);
  double within = 0;
  for (const float distance : {0.05F, 0.1F, 0.2F, 0.4F}) {
    const double share = share_through(aim, {0, 0, 0}, few, distance);
    EXPECT_GT(share, within + 0.03) << distance;
    within = share;
  }
  EXPECT_GT(share_through(aim, {0, 0, 0}, {5, -0.6F, -0.4F}, 0.1F), 0.45 * even);
  aim.learn(rays_through(few, {{0, 0, 0}}, 4096));
  EXPECT_GT(share_through(aim, {0, 0, 0}, few, 0.01F), 0.95 * 0.5 * 0.85);
  EXPECT_GT(share_through(aim, {0, 0, 0}, {5, -0.6F, -0.4F}, 0.1F), 0.45 * even);
  const double learned = share_through(aim, {0, 0, 0}, few, 0.01F);
  aim.guess(rays);
  EXPECT_EQ(share_through(aim, {0, 0, 0}, few, 0.01F), learned) << "which is no longer guessed";
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(aim, towards_target), cap, cap * 0.05);
}

double density(const Aim& aim, const Imath::V2f& u) {
  return static_cast<double>(aim.point(u).pdf) * 4 * std::pow(static_cast<double>(aim.half_size()), 2);
}

// Few rays say little of what lies between them, many much of where they pass.
TEST(Aim, IsAsSharpAsRaysAreMany) {
  std::vector<ShownRay> few;
  for (std::uint32_t i = 0; i < 64; ++i) {
    const auto u = Sampler(5, Purpose::pilot, 0, 0, i).group(0);
    few.push_back({{0, 0, 0}, Imath::V3f(5, u[0] - 0.5F, u[1] - 0.5F).normalized(), 1});
  }
  std::vector<ShownRay> many;
  for (int i = 0; i < 1024; ++i) many.insert(many.end(), few.begin(), few.end());
  Aim aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  const auto largest = [&](const std::vector<ShownRay>& shown) {
    aim.learn(shown);
    double most = 0;
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const auto u = Sampler(6, Purpose::pilot, 0, 0, i).group(0);
      most = std::max(most, density(aim, {u[0], u[1]}));
    }
    return most;
  };
  EXPECT_LT(largest(few), 8);
  EXPECT_GT(largest(many), 15);
}

// Of the target, by its points and their densities, the area of a box between those y and those z [m^2].
double area_within(const Aim& aim, const Imath::V2f& y, const Imath::V2f& z) {
  constexpr std::uint32_t kCount = 1 << 17;
  double area = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(7, Purpose::pilot, 0, 0, i).group(0);
    const AimedPoint at = aim.point({u[0], u[1]});
    if (at.point.y > y.x && at.point.y < y.y && at.point.z > z.x && at.point.z < z.y)
      area += 1 / static_cast<double>(at.pdf) / kCount;
  }
  return area;
}

// Where rays are even, and where the grids of most and of few overlap.
TEST(Aim, PointsHaveTheDensityTheyAreDrawnBy) {
  std::vector<ShownRay> rays;
  for (std::uint32_t i = 0; i < 6400; ++i) {
    const auto u = Sampler(5, Purpose::pilot, 0, 0, i).group(0);
    rays.push_back({{0, 0, 0}, Imath::V3f(5, u[0] / 2 - 0.25F, u[1] / 2 - 0.25F).normalized(), 1});
  }
  Aim aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  aim.learn(rays);
  EXPECT_NEAR(area_within(aim, {-0.2F, 0.2F}, {-0.2F, 0.2F}), 0.16, 0.004 * 0.16);
  for (int i = 0; i < 60; ++i) rays.push_back({{0, 0, 0}, Imath::V3f(5, 0.45F, 0).normalized(), 1});
  aim.learn(rays);
  EXPECT_NEAR(area_within(aim, {0.2F, 0.35F}, {-0.1F, 0.1F}), 0.03, 0.01 * 0.03);
}

// Between four places where all rays pass, light that they have not shown is drawn too, for a tenth of a
// grid that is a third of the target.
TEST(Aim, NothingWithinAGridIsLeftOut) {
  Aim aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  std::vector<ShownRay> rays;
  for (const float y : {-0.5F, 0.5F})
    for (const float z : {-0.5F, 0.5F})
      for (const ShownRay& ray : rays_through({5, y, z}, {{0, 0, 0}}, 10000)) rays.push_back(ray);
  aim.learn(rays);
  double least = 9;
  for (std::uint32_t i = 0; i < 1 << 14; ++i) {
    const auto u = Sampler(6, Purpose::pilot, 0, 0, i).group(0);
    const Imath::V3f at = aim.point({u[0], u[1]}).point;
    if (std::max(std::abs(at.y), std::abs(at.z)) > 0.5F) continue;
    least = std::min(least, density(aim, {u[0], u[1]}));
  }
  EXPECT_GT(least, 0.1 + 0.2);
}

// Light of a lamp comes through a small hole half way to the target, wherever on the lamp it starts: the hole
// is aimed at from everywhere on it, whatever was shown there.
TEST(Aim, FindsTheDistanceWhereRaysOfALampPass) {
  constexpr float kRadius = 0.5F;
  Aim aim({0, 0, 0}, kRadius, {5, 0, 0}, 1);
  const Imath::V3f hole(2.5F, 0.1F, -0.1F);
  std::vector<Imath::V3f> starts;
  for (int i = -8; i <= 8; ++i)
    for (int k = -8; k <= 8; ++k)
      starts.push_back({0, kRadius * static_cast<float>(i) / 8, kRadius * static_cast<float>(k) / 8});
  aim.learn(rays_through(hole, starts, 16));
  for (const float y : {-0.47F, 0.03F, 0.4F})
    EXPECT_GT(share_through(aim, {0, y, -0.2F}, hole, 0.06F), 0.7) << y;
  EXPECT_NEAR(integral(aim, one), 4 * std::numbers::pi, 0.3);
  EXPECT_NEAR(aim.half_size(), 0.76, 0.03) << "all of the target is covered from all of the lamp";
}

// Far lights are aimed likewise, at points of a target that all directions of theirs meet.
TEST(Aim, RaysFromAfarPassWhereTheirTargetStands) {
  constexpr float kTan = 0.01F;
  Aim aim = Aim::from_afar({1, 0, 0}, 1 / std::hypot(1.0, static_cast<double>(kTan)), {0, 0, 0}, 1);
  aim.guide();
  const Imath::V3f slit(-1.2F, 0.2F, 0.1F);
  std::vector<ShownRay> rays;
  for (int i = -8; i <= 8; ++i)
    for (int k = 0; k < 16; ++k) {
      const Imath::V3f direction = Imath::V3f(1, kTan * static_cast<float>(i) / 8, 0).normalized();
      rays.push_back({slit - direction * 10, direction, 1});
    }
  aim.learn(rays);
  double through = 0;
  double area = 0;
  constexpr std::uint32_t kCount = 1 << 14;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(3, Purpose::pilot, 0, 0, i).group(0);
    const AimedPoint at = aim.point({u[0], u[1]});
    through += (at.point - slit).length() < 0.15F ? 1 : 0;
    area += 1 / static_cast<double>(at.pdf) / kCount;
    EXPECT_LT(at.point.x, -0.9F);
  }
  EXPECT_GT(through / kCount, 0.7);
  EXPECT_NEAR(area, 4 * std::pow(aim.half_size(), 2), 0.05 * area);
  EXPECT_GE(aim.half_size(), 1 + 1.1F * kTan) << "whichever way they come, all of the target is covered";
}

// Directions are rounded to float: seen from afar that is a part of a cell, and cells differ by any factor.
TEST(Aim, AFarTargetIsIntegratedPrecisely) {
  constexpr float kDistance = 3000;
  const Imath::V3f axis(0.48F, 0.6F, 0.64F);
  Aim aim({0, 0, 0}, 0, axis * kDistance, 1);
  aim.learn(rays_through(axis * kDistance + Imath::V3f(0.3F, 0.2F, 0), {{0, 0, 0}}, 64));
  const auto within = [&axis](const Imath::V3f& w) {
    return w.cross(axis).length() < 0.9F / kDistance ? 1.0 : 0.0;
  };
  const double circle = std::numbers::pi * 0.81 / (kDistance * kDistance);
  EXPECT_NEAR(integral(aim, within), circle, circle * 0.01);
}

TEST(Aim, AnEmitterReachingBeyondItsTargetIsStillDrawnByTheStatedDensity) {
  const Aim aim({0, 0, 0}, 0, {5, 0, 0}, 1);
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

// Its emission shows what it learns from, and directions are then drawn by the density that it states.
TEST(Aim, ALightInsideItsTargetIsAimedOnceItHasLearnt) {
  EXPECT_TRUE(Aim({0, 0, 0}, 0, {5, 0, 0}, 1).guided());
  Aim aim({0, 0, 0}, 0, {0.5F, 0, 0}, 1);
  EXPECT_FALSE(aim.guided());
  std::vector<ShownRay> shown;
  const Imath::V3f hot = Imath::V3f(0.48F, -0.6F, 0.64F);
  constexpr std::uint32_t kCount = 1 << 16;
  const auto direction = [&](std::uint32_t i) {
    const auto u = Sampler(1, Purpose::pilot, 0, 0, i).group(0);
    return aim.sample(kPoint, kOrigin, u[2], {u[0], u[1]}, 0);
  };
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const AimedDirection d = direction(i);
    EXPECT_FLOAT_EQ(d.pdf, 1 / (4 * std::numbers::pi_v<float>));
    if (d.wi.dot(hot) > 0.99F) shown.push_back({{0, 0, 0}, d.wi, 1});
  }
  aim.learn(shown);
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

#include "transport/plan/photon_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sampling/sampler.h"

namespace abbe {
namespace {

const Light kPoint{"point", PointLight{{0, 0, 0}}, Curve(1.0)};
const EmissionPoint kOrigin{{0, 0, 0}, {0, 0, 0}, 1};

// Estimates the integral of g over directions with the guide's own samples and pdfs.
template <typename G>
double integral(const PhotonGuide& aim, G g) {
  constexpr std::uint32_t kCount = 1 << 17;
  double sum = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(1, Purpose::pilot, 0, 0, i).group(0);
    const GuidedDirection d = aim.sample(kPoint, kOrigin, u[2], {u[0], u[1]}, 0);
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

TEST(PhotonGuide, DensitiesCoverTheWholeSphereOnce) {
  EXPECT_NEAR(integral(PhotonGuide(), one), 4 * std::numbers::pi, 0.02);
  EXPECT_NEAR(integral(PhotonGuide({0, 0, 0}, 0, {5, 0, 0}, 1), one), 4 * std::numbers::pi, 0.3);
}

TEST(PhotonGuide, TheTargetIsIntegratedPrecisely) {
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(PhotonGuide({0, 0, 0}, 0, {5, 0, 0}, 1), towards_target), cap, cap * 0.01);
}

// Rays from each of the given starts through one point, `each` per start.
std::vector<PilotRay> rays_through(const Imath::V3f& place, const std::vector<Imath::V3f>& starts,
                                   std::size_t each) {
  std::vector<PilotRay> rays;
  for (const Imath::V3f& from : starts) rays.insert(rays.end(), each, {from, (place - from).normalized(), 1});
  return rays;
}

// Fraction of the directions sampled for a photon at `from` that pass through a ball.
double share_through(const PhotonGuide& aim, const Imath::V3f& from, const Imath::V3f& center, float radius) {
  constexpr std::uint32_t kCount = 1 << 14;
  double through = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(3, Purpose::pilot, 0, 0, i).group(0);
    const GuidedDirection d = aim.sample(kPoint, {from, {0, 0, 0}, 1}, u[2], {u[0], u[1]}, 0);
    through += (center - from).cross(d.wi).length() < radius && d.wi.dot(center - from) > 0 ? 1 : 0;
  }
  return through / kCount;
}

// A caster of a hundredth of the size of another one gets a quarter of the photons before training.
TEST(PhotonGuide, SendsAsManyPhotonsToASmallCasterAsToALargeOne) {
  const BoundingSphere large{{5, 0.3F, 0}, 0.6F};
  const BoundingSphere small{{5.2F, -0.8F, -0.2F}, 0.006F};
  PhotonGuide aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  EXPECT_LT(share_through(aim, {0, 0, 0}, small.center, small.radius), 0.001);
  aim.stratify({{large, small}});
  EXPECT_GT(share_through(aim, {0, 0, 0}, small.center, small.radius), 0.95 * 0.25 * 0.7);
  EXPECT_GT(share_through(aim, {0, 0, 0}, large.center, large.radius), 0.95 * 0.25 * 0.7);
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(aim, towards_target), cap, cap * 0.02);
  aim.train(rays_through({5, 0.3F, 0.2F}, {{0, 0, 0}}, 4096));
  EXPECT_GT(share_through(aim, {0, 0, 0}, {5, 0.3F, 0.2F}, 0.01F), 0.95 * 0.9 * 0.85);
}

TEST(PhotonGuide, StrataOfADistantLightKeepTheirIntegral) {
  PhotonGuide aim = PhotonGuide::for_distant_light({0, 0, -1}, 0.9999, {0, 0, 0}, 1);
  aim.enable_guiding();
  const BoundingSphere small{{0.5F, 0.2F, 0.3F}, 0.02F};
  aim.stratify({{small, {{-0.4F, 0, 0}, 0.5F}}});
  constexpr std::uint32_t kCount = 1 << 15;
  double area = 0;
  double near_small = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(5, Purpose::pilot, 0, 0, i).group(0);
    const GuidedPoint drawn = aim.point({u[0], u[1]});
    area += 1 / static_cast<double>(drawn.pdf) / kCount;
    const Imath::V3f offset = drawn.point - small.center;
    near_small += offset.x * offset.x + offset.y * offset.y < 0.04F * 0.04F ? 1.0 / kCount : 0;
  }
  EXPECT_NEAR(area, 4 * static_cast<double>(aim.half_size()) * static_cast<double>(aim.half_size()), 0.1);
  EXPECT_GT(near_small, 0.24);
}

TEST(PhotonGuide, LearningMovesDensityAndKeepsTheIntegral) {
  PhotonGuide aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  const Imath::V3f hot(5, 0.3F, 0.2F);
  aim.train(rays_through(hot, {{0, 0, 0}}, 4096));
  EXPECT_GT(share_through(aim, {0, 0, 0}, hot, 0.01F), 0.95 * 0.9 * 0.85);
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(aim, towards_target), cap, cap * 0.05);
}

// Most rays have one direction, a few a very different one. Both are guided, not left to the uniform
// fraction.
TEST(PhotonGuide, WhereFewGoIsAimedAtToo) {
  PhotonGuide aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  const Imath::V3f most(5, 0.3F, 0.2F);
  const Imath::V3f few(5, -0.6F, -0.4F);
  std::vector<PilotRay> rays = rays_through(most, {{0, 0, 0}}, 10000);
  for (const PilotRay& ray : rays_through(few, {{0, 0, 0}}, 50)) rays.push_back(ray);
  aim.train(rays);
  EXPECT_GT(share_through(aim, {0, 0, 0}, most, 0.01F), 0.5);
  EXPECT_GT(share_through(aim, {0, 0, 0}, few, 0.3F), 0.08);
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(aim, towards_target), cap, cap * 0.05);
}

// Two rays close to each other do not determine the extent of a caustic: samples cover every distance, and
// half of them are uniform.
TEST(PhotonGuide, GuessesAroundFewAtAllDistances) {
  PhotonGuide aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  const double even = share_through(aim, {0, 0, 0}, {5, -0.6F, -0.4F}, 0.1F);
  const Imath::V3f few(5, 0.3F, 0.2F);
  std::vector<PilotRay> rays = rays_through(few, {{0, 0, 0}}, 1);
  rays.push_back(rays_through({5, 0.301F, 0.2F}, {{0, 0, 0}}, 1).front());
  aim.train_from_few(rays);
  double within = 0;
  for (const float distance : {0.05F, 0.1F, 0.2F, 0.4F}) {
    const double share = share_through(aim, {0, 0, 0}, few, distance);
    EXPECT_GT(share, within + 0.03) << distance;
    within = share;
  }
  EXPECT_GT(share_through(aim, {0, 0, 0}, {5, -0.6F, -0.4F}, 0.1F), 0.45 * even);
  aim.train(rays_through(few, {{0, 0, 0}}, 4096));
  EXPECT_GT(share_through(aim, {0, 0, 0}, few, 0.01F), 0.95 * 0.5 * 0.85);
  EXPECT_GT(share_through(aim, {0, 0, 0}, {5, -0.6F, -0.4F}, 0.1F), 0.45 * even);
  const double learned = share_through(aim, {0, 0, 0}, few, 0.01F);
  aim.train_from_few(rays);
  EXPECT_EQ(share_through(aim, {0, 0, 0}, few, 0.01F), learned) << "which is no longer guessed";
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(integral(aim, towards_target), cap, cap * 0.05);
}

double density(const PhotonGuide& aim, const Imath::V2f& u) {
  return static_cast<double>(aim.point(u).pdf) * 4 * std::pow(static_cast<double>(aim.half_size()), 2);
}

// A grid of few rays is smooth, one of many rays is sharp.
TEST(PhotonGuide, IsAsSharpAsRaysAreMany) {
  std::vector<PilotRay> few;
  for (std::uint32_t i = 0; i < 64; ++i) {
    const auto u = Sampler(5, Purpose::pilot, 0, 0, i).group(0);
    few.push_back({{0, 0, 0}, Imath::V3f(5, u[0] - 0.5F, u[1] - 0.5F).normalized(), 1});
  }
  std::vector<PilotRay> many;
  for (int i = 0; i < 1024; ++i) many.insert(many.end(), few.begin(), few.end());
  PhotonGuide aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  const auto largest = [&](const std::vector<PilotRay>& shown) {
    aim.train(shown);
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

// Area [m^2] of a box of the target between the given y and z, estimated with sampled points and their pdfs.
double area_within(const PhotonGuide& aim, const Imath::V2f& y, const Imath::V2f& z) {
  constexpr std::uint32_t kCount = 1 << 17;
  double area = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(7, Purpose::pilot, 0, 0, i).group(0);
    const GuidedPoint at = aim.point({u[0], u[1]});
    if (at.point.y > y.x && at.point.y < y.y && at.point.z > z.x && at.point.z < z.y)
      area += 1 / static_cast<double>(at.pdf) / kCount;
  }
  return area;
}

// Checks uniform rays, and the overlap of the grids of frequent and rare rays.
TEST(PhotonGuide, PointsHaveTheDensityTheyAreDrawnBy) {
  std::vector<PilotRay> rays;
  for (std::uint32_t i = 0; i < 6400; ++i) {
    const auto u = Sampler(5, Purpose::pilot, 0, 0, i).group(0);
    rays.push_back({{0, 0, 0}, Imath::V3f(5, u[0] / 2 - 0.25F, u[1] / 2 - 0.25F).normalized(), 1});
  }
  PhotonGuide aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  aim.train(rays);
  EXPECT_NEAR(area_within(aim, {-0.2F, 0.2F}, {-0.2F, 0.2F}), 0.16, 0.004 * 0.16);
  for (int i = 0; i < 60; ++i) rays.push_back({{0, 0, 0}, Imath::V3f(5, 0.45F, 0).normalized(), 1});
  aim.train(rays);
  EXPECT_NEAR(area_within(aim, {0.2F, 0.35F}, {-0.1F, 0.1F}), 0.03, 0.01 * 0.03);
}

// All rays pass through four points. The space between them is sampled as well: it has a tenth of the density
// of a grid over a third of the target.
TEST(PhotonGuide, NothingWithinAGridIsLeftOut) {
  PhotonGuide aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  std::vector<PilotRay> rays;
  for (const float y : {-0.5F, 0.5F})
    for (const float z : {-0.5F, 0.5F})
      for (const PilotRay& ray : rays_through({5, y, z}, {{0, 0, 0}}, 10000)) rays.push_back(ray);
  aim.train(rays);
  double least = 9;
  for (std::uint32_t i = 0; i < 1 << 14; ++i) {
    const auto u = Sampler(6, Purpose::pilot, 0, 0, i).group(0);
    const Imath::V3f at = aim.point({u[0], u[1]}).point;
    if (std::max(std::abs(at.y), std::abs(at.z)) > 0.5F) continue;
    least = std::min(least, density(aim, {u[0], u[1]}));
  }
  EXPECT_GT(least, 0.1 + 0.2);
}

// Light of an extended light passes through a small hole half way to the target. After training with some of
// its points, photons from every point of it are guided to the hole.
TEST(PhotonGuide, FindsTheDistanceWhereRaysOfALampPass) {
  constexpr float kRadius = 0.5F;
  PhotonGuide aim({0, 0, 0}, kRadius, {5, 0, 0}, 1);
  const Imath::V3f hole(2.5F, 0.1F, -0.1F);
  std::vector<Imath::V3f> starts;
  for (int i = -8; i <= 8; ++i)
    for (int k = -8; k <= 8; ++k)
      starts.push_back({0, kRadius * static_cast<float>(i) / 8, kRadius * static_cast<float>(k) / 8});
  aim.train(rays_through(hole, starts, 16));
  for (const float y : {-0.47F, 0.03F, 0.4F})
    EXPECT_GT(share_through(aim, {0, y, -0.2F}, hole, 0.06F), 0.7) << y;
  EXPECT_NEAR(integral(aim, one), 4 * std::numbers::pi, 0.3);
  EXPECT_NEAR(aim.half_size(), 0.76, 0.03) << "all of the target is covered from all of the lamp";
}

// Distant lights are guided to points of a target that covers the directions of all their rays.
TEST(PhotonGuide, RaysFromAfarPassWhereTheirTargetStands) {
  constexpr float kTan = 0.01F;
  PhotonGuide aim =
      PhotonGuide::for_distant_light({1, 0, 0}, 1 / std::hypot(1.0, static_cast<double>(kTan)), {0, 0, 0}, 1);
  aim.enable_guiding();
  const Imath::V3f slit(-1.2F, 0.2F, 0.1F);
  std::vector<PilotRay> rays;
  for (int i = -8; i <= 8; ++i)
    for (int k = 0; k < 16; ++k) {
      const Imath::V3f direction = Imath::V3f(1, kTan * static_cast<float>(i) / 8, 0).normalized();
      rays.push_back({slit - direction * 10, direction, 1});
    }
  aim.train(rays);
  double through = 0;
  double area = 0;
  constexpr std::uint32_t kCount = 1 << 14;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(3, Purpose::pilot, 0, 0, i).group(0);
    const GuidedPoint at = aim.point({u[0], u[1]});
    through += (at.point - slit).length() < 0.15F ? 1 : 0;
    area += 1 / static_cast<double>(at.pdf) / kCount;
    EXPECT_LT(at.point.x, -0.9F);
  }
  EXPECT_GT(through / kCount, 0.7);
  EXPECT_NEAR(area, 4 * std::pow(aim.half_size(), 2), 0.05 * area);
  EXPECT_GE(aim.half_size(), 1 + 1.1F * kTan) << "whichever way they come, all of the target is covered";
}

// Rounding of directions to float is a fraction of a cell for a distant target, although cells differ by any
// factor.
TEST(PhotonGuide, AFarTargetIsIntegratedPrecisely) {
  constexpr float kDistance = 3000;
  const Imath::V3f axis(0.48F, 0.6F, 0.64F);
  PhotonGuide aim({0, 0, 0}, 0, axis * kDistance, 1);
  aim.train(rays_through(axis * kDistance + Imath::V3f(0.3F, 0.2F, 0), {{0, 0, 0}}, 64));
  const auto within = [&axis](const Imath::V3f& w) {
    return w.cross(axis).length() < 0.9F / kDistance ? 1.0 : 0.0;
  };
  const double circle = std::numbers::pi * 0.81 / (kDistance * kDistance);
  EXPECT_NEAR(integral(aim, within), circle, circle * 0.01);
}

TEST(PhotonGuide, AnEmitterReachingBeyondItsTargetIsStillDrawnByTheStatedDensity) {
  const PhotonGuide aim({0, 0, 0}, 0, {5, 0, 0}, 1);
  const EmissionPoint beyond{{7, 0.5F, 0}, {0, 0, 0}, 1};
  double sum = 0;
  constexpr std::uint32_t kCount = 1 << 16;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = Sampler(1, Purpose::pilot, 0, 0, i).group(0);
    const GuidedDirection d = aim.sample(kPoint, beyond, u[2], {u[0], u[1]}, 0);
    sum += d.wi.x < -0.99F ? 1 / static_cast<double>(d.pdf) : 0;
  }
  const double cap = 2 * std::numbers::pi * 0.01;
  EXPECT_NEAR(sum / kCount, cap, cap * 0.02);
}

// The light's own emission trains the guide; afterwards the pdf of a sampled direction equals the stated one.
TEST(PhotonGuide, ALightInsideItsTargetIsAimedOnceItHasLearnt) {
  EXPECT_TRUE(PhotonGuide({0, 0, 0}, 0, {5, 0, 0}, 1).is_guided());
  PhotonGuide aim({0, 0, 0}, 0, {0.5F, 0, 0}, 1);
  EXPECT_FALSE(aim.is_guided());
  std::vector<PilotRay> shown;
  const Imath::V3f hot = Imath::V3f(0.48F, -0.6F, 0.64F);
  constexpr std::uint32_t kCount = 1 << 16;
  const auto direction = [&](std::uint32_t i) {
    const auto u = Sampler(1, Purpose::pilot, 0, 0, i).group(0);
    return aim.sample(kPoint, kOrigin, u[2], {u[0], u[1]}, 0);
  };
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const GuidedDirection d = direction(i);
    EXPECT_FLOAT_EQ(d.pdf, 1 / (4 * std::numbers::pi_v<float>));
    if (d.wi.dot(hot) > 0.99F) shown.push_back({{0, 0, 0}, d.wi, 1});
  }
  aim.train(shown);
  EXPECT_TRUE(aim.is_guided());
  int aimed = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) aimed += direction(i).wi.dot(hot) > 0.97F ? 1 : 0;
  EXPECT_GT(aimed, 0.8 * kCount);
  EXPECT_NEAR(integral(aim, one), 4 * std::numbers::pi, 0.3);
  const auto near_hot = [&](const Imath::V3f& w) { return w.dot(hot) > 0.995F ? 1.0 : 0.0; };
  EXPECT_NEAR(integral(aim, near_hot), 2 * std::numbers::pi * 0.005, 0.01 * 2 * std::numbers::pi * 0.005);
}

}  // namespace
}  // namespace abbe

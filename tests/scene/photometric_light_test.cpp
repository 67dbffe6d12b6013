#include "scene/lights/photometric_light.h"

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "scene/lights/light.h"
#include "tests/angles.h"

namespace abbe {
namespace {

using Imath::V3f;
using Table = IntensityDistribution::Table;

V3f direction(double gamma_deg, double plane_deg) {
  const double gamma = gamma_deg * kPi / 180;
  const double plane = plane_deg * kPi / 180;
  return V3f(
      Imath::V3d(std::sin(gamma) * std::cos(plane), std::sin(gamma) * std::sin(plane), std::cos(gamma)));
}

// An asymmetric table whose values differ everywhere.
Table uneven() {
  Table table{{10, 40, 90, 150}, {30, 120, 200, 390}, {}};
  for (const double plane : {1.0, 3.0, 2.0, 1.0})
    for (const double gamma : {4.0, 2.0, 5.0, 0.5}) table.candelas.push_back(plane * gamma);
  return table;
}

// Integral over all directions, by the midpoint rule in the cosine and the azimuth.
template <typename Function>
double integral(const Function& function) {
  constexpr int kHeights = 2000;
  constexpr int kTurns = 720;
  double sum = 0;
  for (int i = 0; i < kHeights; ++i)
    for (int j = 0; j < kTurns; ++j) {
      const double gamma = std::acos(1 - 2 * (i + 0.5) / kHeights) * 180 / kPi;
      sum += static_cast<double>(function(direction(gamma, (j + 0.5) * 360 / kTurns)));
    }
  return sum * 4 * kPi / (kHeights * kTurns);
}

TEST(IntensityDistribution, InterpolatesInBothAngles) {
  const IntensityDistribution distribution(uneven());
  const double unit = distribution.luminous_flux() / (4 * kPi);
  const auto candelas = [&](double gamma, double plane) {
    return static_cast<double>(distribution.relative_intensity(direction(gamma, plane))) * unit;
  };
  EXPECT_NEAR(candelas(40, 120), 3 * 2, 1e-4);
  EXPECT_NEAR(candelas(65, 120), 3 * 3.5, 1e-4);
  EXPECT_NEAR(candelas(40, 75), 2 * 2, 1e-4);
  EXPECT_NEAR(candelas(40, 295), 1.5 * 2, 1e-4) << "between the last measured half-plane and the first";
  EXPECT_NEAR(candelas(40, 10), (1 + 20.0 / 190) * 2, 1e-4);
  EXPECT_EQ(candelas(9, 120), 0) << "before the first vertical angle";
  EXPECT_EQ(candelas(151, 120), 0) << "after the last vertical angle";
  EXPECT_NEAR(distribution.max_relative_intensity() * unit, 15, 1e-9);
}

TEST(IntensityDistribution, FluxIsTheIntegral) {
  const IntensityDistribution even(Table{{0, 180}, {0, 360}, {2, 2, 2, 2}});
  EXPECT_NEAR(even.luminous_flux(), 8 * kPi, 1e-9);
  EXPECT_FLOAT_EQ(even.relative_intensity(direction(77, 200)), 1);
  const IntensityDistribution distribution(uneven());
  EXPECT_NEAR(integral([&](const V3f& w) { return distribution.relative_intensity(w); }) / (4 * kPi), 1,
              1e-3);
}

TEST(IntensityDistribution, SamplesByItsDensity) {
  const IntensityDistribution distribution(uneven());
  EXPECT_NEAR(integral([&](const V3f& w) { return distribution.pdf(w); }), 1, 2e-3);
  // The mean of f/pdf is the integral of f, here of the intensity times another function of the direction.
  const auto f = [&](const V3f& w) {
    return distribution.relative_intensity(w) * (1 + w.x + 0.5F * w.z * w.y);
  };
  double sum = 0;
  constexpr int kSide = 500;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const V3f w = distribution.sample(
          {(static_cast<float>(i) + 0.5F) / kSide, (static_cast<float>(j) + 0.5F) / kSide});
      EXPECT_NEAR(w.length(), 1, 1e-5);
      const float pdf = distribution.pdf(w);
      if (pdf > 0) sum += static_cast<double>(f(w) / pdf);
    }
  EXPECT_NEAR(sum / (kSide * kSide) / integral(f), 1, 5e-3);
}

// A luminaire that shines down, with C = 0 along +x: C = 90 degrees is +y, counter-clockwise from above.
TEST(PhotometricLight, TurnsItsPlanesCounterClockwiseFromAbove) {
  const auto distribution = std::make_shared<const IntensityDistribution>(
      Table{{0, 90}, {0, 90, 180, 270, 360}, {1, 1, 1, 2, 1, 3, 1, 4, 1, 1}});
  const Light light{"lamp", PhotometricLight{{0, 0, 2}, {0, 0, -1}, {1, 0, 0}, distribution}, Curve(1.0)};
  const auto towards = [&](const V3f& wo) {
    return static_cast<double>(emission_factor(light, V3f(0), wo.normalized(), 0)) *
           distribution->luminous_flux() / (4 * kPi);
  };
  EXPECT_NEAR(towards({0, 0, -1}), 1, 1e-5);
  const float off = 1e-4F;  // below the horizon
  EXPECT_NEAR(towards({1, 0, -off}), 1, 1e-2);
  EXPECT_NEAR(towards({0, 1, -off}), 2, 1e-2);
  EXPECT_NEAR(towards({-1, 0, -off}), 3, 1e-2);
  EXPECT_NEAR(towards({0, -1, -off}), 4, 1e-2);
  EXPECT_EQ(towards({0, 0, 1}), 0);
  EXPECT_TRUE(light.is_delta());
  EXPECT_FALSE(sample_light(light, {}, {{0, 0, 3}}, {0.5F, 0.5F}, 0)) << "above";
  const auto below = sample_light(light, {}, {{0, 0, 0}}, {0.5F, 0.5F}, 0);
  ASSERT_TRUE(below);
  EXPECT_NEAR(static_cast<double>(below->factor) * distribution->luminous_flux() / (4 * kPi), 0.25, 1e-5);
}

}  // namespace
}  // namespace abbe

#include "scene/lights/light.h"

#include <gtest/gtest.h>

#include <set>

#include "light_kinds.h"
#include "scene/shapes/ray.h"
#include "tests/angles.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;
using test::all_light_kinds;
using test::LightKind;
using test::Random;

constexpr float kRadius = 3;

TEST(Emission, OfAllKinds) {
  std::set<std::size_t> kinds;
  for (const LightKind& one : all_light_kinds()) kinds.insert(one.light().kind.index());
  EXPECT_EQ(kinds.size(), std::variant_size_v<decltype(Light::kind)>);
}

// Integrates over all directions, by strata of height and azimuth; for a narrow sun within a cone of twice
// its height.
TEST(Emission, DirectionsIntegrateToOne) {
  for (const auto& [name, scene] : all_light_kinds()) {
    const Light& light = scene.lights[0];
    if (light.is<DirectionalLight>()) {
      EXPECT_EQ(emission_density(light, V3f(0), {0, -0.6F, -0.8F}, kRadius, 0).pdf_direction, 1);
      continue;
    }
    const auto* sun = std::get_if<SunLight>(&light.kind);
    const V3f axis = sun != nullptr ? -sun->towards : V3f(0, 0, 1);
    const float height = sun != nullptr ? 2 * sun->cap : 2;
    const V3f normal = V3f(0.6F, 0, 0.8F);
    Random random(1);
    double sum = 0;
    constexpr int kSide = 500;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const V3f wo = direction_about(
            axis, (static_cast<float>(i) + random.uniform()) / kSide * height,
            (static_cast<float>(j) + random.uniform()) / kSide * 2 * std::numbers::pi_v<float>);
        sum += static_cast<double>(emission_density(light, normal, wo, kRadius, 0).pdf_direction);
      }
    EXPECT_NEAR(sum / (kSide * kSide) * 2 * kPi * static_cast<double>(height), 1, 2e-3) << name;
  }
}

TEST(Emission, DirectionsAreDrawnAsTheDensitySays) {
  Random random(2);
  for (const auto& [name, scene] : all_light_kinds()) {
    const Light& light = scene.lights[0];
    if (light.at_infinity()) continue;
    const V3f normal = V3f(0.6F, 0, 0.8F);
    // Both are functions of the cosine with the axis. The test compares the fraction in each of several bins.
    const auto* spot = std::get_if<SpotLight>(&light.kind);
    const V3f axis = light.is<AreaLight>() ? normal : spot != nullptr ? spot->axis : V3f(0, 0, 1);
    constexpr int kBins = 20;
    constexpr int kCount = 100000;
    std::array<double, kBins> drawn{};
    std::array<double, kBins> expected{};
    for (int i = 0; i < kCount; ++i) {
      const V3f wo = emission_direction(light, normal, random.pair(), 0);
      EXPECT_GT(emission_density(light, normal, wo, kRadius, 0).pdf_direction, 0) << name;
      const double z = std::clamp(static_cast<double>(wo.dot(axis)), -1.0, 0.999999);
      drawn[static_cast<std::size_t>((z + 1) / 2 * kBins)] += 1.0 / kCount;
    }
    constexpr int kSteps = 100 * kBins;
    for (int i = 0; i < kSteps; ++i) {
      const auto cap = static_cast<float>(2 - 2 * (i + 0.5) / kSteps);
      const V3f wo = direction_about(axis, cap, 0.7F);
      expected[static_cast<std::size_t>(i / (kSteps / kBins))] +=
          static_cast<double>(emission_density(light, normal, wo, kRadius, 0).pdf_direction) * 4 * kPi /
          kSteps;
    }
    for (std::size_t bin = 0; bin < kBins; ++bin)
      EXPECT_NEAR(drawn[bin], expected[bin], 5e-3) << name << ", bin " << bin;
  }
}

TEST(Emission, PointsAreDrawnAsTheDensitySays) {
  for (const auto& [name, scene] : all_light_kinds()) {
    const Light& light = scene.lights[0];
    const float pdf = emission_density(light, {0, 0, -1}, {0, 0, -1}, kRadius, 0).pdf_position;
    if (light.at_infinity())
      EXPECT_FLOAT_EQ(pdf, static_cast<float>(1 / (9 * kPi))) << name;
    else
      EXPECT_EQ(pdf, sample_emission_point(light, scene.shapes, {0.3F, 0.6F}, 0).pdf_area) << name;
  }
}

// The density with which a scene point samples a point of the light: pdf_solid_angle |cos|/d^2 per area of
// the light, which integrates to 1.
TEST(Emission, DensityPerAreaIsThatPerSolidAngleTimesCosineOverDistanceSquared) {
  const V3f from(0.1F, -0.2F, 0.05F);
  for (const auto& [name, scene] : all_light_kinds()) {
    const Light& light = scene.lights[0];
    if (light.is_delta() || light.at_infinity()) continue;
    const double radius =
        std::holds_alternative<Sphere>(scene.shapes[0].shape) ? 1 : 0;  // the far side is hidden
    double sum = 0;
    Random random(3);
    constexpr int kSide = 400;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const EmissionPoint at = sample_emission_point(light, scene.shapes,
                                                       {(static_cast<float>(i) + random.uniform()) / kSide,
                                                        (static_cast<float>(j) + random.uniform()) / kSide},
                                                       0);
        const V3f d = at.point - from;
        const V3f wi = d.normalized();
        if (radius > 0 && at.normal.dot(wi) > 0) continue;
        const double per_area =
            static_cast<double>(light_pdf(light, scene.shapes, {from}, wi, at.point, at.normal, 0) *
                                std::abs(at.normal.dot(wi)) / d.length2());
        sum += per_area / static_cast<double>(at.pdf_area);
      }
    EXPECT_NEAR(sum / (kSide * kSide), 1, 3e-3) << name;
  }
}

}  // namespace
}  // namespace abbe

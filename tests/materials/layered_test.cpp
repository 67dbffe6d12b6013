#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/interface/fresnel.h"
#include "materials/material.h"
#include "tests/angles.h"
#include "tests/materials/bsdf_examples.h"
#include "tests/materials/hemisphere.h"
#include "tests/materials/index_of.h"

namespace abbe {
namespace {

using Imath::V3f;

double mean_reflectance(double eta) {
  constexpr int kSteps = 200000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double c = (i + 0.5) / kSteps;
    sum += 2 * c * fresnel_dielectric(c, eta).R() / kSteps;
  }
  return sum;
}

TEST(HemisphericalFresnel, IsTheMeanOverDirections) {
  EXPECT_NEAR(diffuse_reflectance_inside(1 / 1.5), 0.09177796, 1e-8);
  EXPECT_NEAR(diffuse_reflectance_inside(1.5), 0.59634576, 1e-8);
  for (const double eta : {1.0, 1.00005, 1.0002, 1.001, 1.01, 1.33, 2.4, 4.0}) {
    EXPECT_NEAR(diffuse_reflectance_inside(1 / eta), mean_reflectance(eta), 1e-6) << eta;
    EXPECT_NEAR(diffuse_reflectance_inside(eta), mean_reflectance(1 / eta), 1e-5) << eta;
    EXPECT_NEAR(diffuse_reflectance(eta, 0), mean_reflectance(eta), 5e-5) << eta;
    EXPECT_NEAR(diffuse_reflectance(1 / eta, 0), mean_reflectance(1 / eta), 2e-3) << eta;
  }
}

CoatedDiffuseBsdf coated(float n, float rho) {
  return coated_diffuse(SampledSpectrum(n), SampledSpectrum(rho),
                        SampledSpectrum(static_cast<float>(diffuse_reflectance_inside(n))), false);
}

// Of the light that the ground scatters up, the fraction 1 - r leaves; the rest returns to the ground.
TEST(CoatedDiffuseBsdf, SumsAllReflectionsBetweenGroundAndCoat) {
  const double r = 0.59634576;
  for (const double rho : {0.0, 0.3, 1.0})
    for (const double cosine : {1.0, 0.5, 0.1}) {
      const FresnelPower<double> f = fresnel_dielectric(cosine, 1.5);
      const double expected = f.transmitted() * rho * (1 - r) / (1 - rho * r);
      const CoatedDiffuseBsdf bsdf = coated(1.5F, static_cast<float>(rho));
      EXPECT_NEAR(spread_reflectance(bsdf, direction(cosine, 1)), expected, 1e-4);
    }
  EXPECT_NEAR(spread_reflectance(coated(1.5F, 1), direction(0.5, 1)) + fresnel_dielectric(0.5, 1.5).R(), 1,
              1e-4);
}

TEST(CoatedDiffuseBsdf, MirrorsByFresnelAndNoMore) {
  const CoatedDiffuseBsdf bsdf = coated(1.5F, 0.5F);
  const V3f wo = direction(0.5, 1);
  const auto s = bsdf.sample(wo, {0, {}}, 0, TransportMode::radiance);
  ASSERT_TRUE(s && s->delta);
  EXPECT_NEAR(s->weight[0] * s->pdf, fresnel_dielectric(0.5, 1.5).R(), 1e-6);
  EXPECT_LT((s->wi - V3f(-wo.x, -wo.y, wo.z)).length(), 1e-6);
}

TEST(CoatedDiffuseBsdf, WithoutACoatIsLamberts) {
  const CoatedDiffuseBsdf bsdf = coated(1, 0.5F);
  const auto s = bsdf.sample(V3f(0, 0.6F, -0.8F), {0, {0.2F, 0.7F}}, 0, TransportMode::radiance);
  ASSERT_TRUE(s && !s->delta);
  EXPECT_FLOAT_EQ(s->weight[0], 0.5F);
}

TEST(CoatedDiffuseMaterial, SeesTheIndexAtEachWavelength) {
  const CoatedDiffuseMaterial material{
      Curve(0.6), "glass",
      RefractiveIndex(Curve({{300, 1.8}, {1100, 1.3}}), Curve(0.0), IndexMedium::air, 300, 1100)};
  EXPECT_NEAR(material.inner(500), diffuse_reflectance_inside(material.index.n(500)), 1e-9);
  const SampledSpectrum wavelengths = packet();
  const Bsdf bsdf = material.bsdf({wavelengths});
  for (const int lane : {0, kLanes - 1}) {
    const double n = material.index.n(wavelengths[lane]);
    const double r = diffuse_reflectance_inside(n);
    EXPECT_NEAR(spread_reflectance(bsdf, V3f(0, 0, 1), lane),
                fresnel_dielectric(1.0, n).transmitted() * 0.6 * (1 - r) / (1 - 0.6 * r), 1e-4);
  }
}

// Reflectance and transmittance at one wavelength.
struct Balance {
  double reflected, transmitted;
};
Balance balance(const ThinGlassBsdf& sheet, double cosine, int lane = 0) {
  const V3f wo = direction(cosine, 1);
  const auto back = sheet.sample(wo, {0, {}}, lane, TransportMode::radiance);
  const auto on = sheet.sample(wo, {0x1.fffffep-1F, {}}, lane, TransportMode::radiance);
  EXPECT_TRUE(back && !back->transmitted && on && on->transmitted && on->delta);
  EXPECT_EQ(on->wi, -wo);
  EXPECT_NEAR(back->pdf + on->pdf, 1, 1e-6);
  return {back->weight[lane] * back->pdf, on->weight[lane] * on->pdf};
}

TEST(ThinGlassBsdf, SumsReflectionsBetweenItsFacesForEachPolarisation) {
  const ThinGlassBsdf clear{SampledSpectrum(1.5F), SampledSpectrum(0)};
  EXPECT_NEAR(balance(clear, 1).transmitted, 0.92307692, 1e-6);
  EXPECT_NEAR(balance(clear, 0.5).transmitted, 0.848128, 1e-6);
  EXPECT_NEAR(balance(clear, 0.5).reflected, 1 - 0.848128, 1e-6);
}

TEST(ThinGlassBsdf, AbsorbsAlongTheWayInside) {
  const ThinGlassBsdf grey{SampledSpectrum(1.5F), SampledSpectrum(1)};
  EXPECT_NEAR(balance(grey, 1).transmitted, 0.33911112, 1e-6);
  EXPECT_NEAR(balance(grey, 1).reflected, 0.04499008, 1e-6);
  const double cos_t = std::sqrt(1 - 0.75 / 2.25);  // the path is longer at 60 degrees
  const ThinGlassBsdf thinner{SampledSpectrum(1.5F), SampledSpectrum(static_cast<float>(cos_t))};
  const FresnelPower<double> f = fresnel_dielectric(0.5, 1.5);
  const double a = std::exp(-1.0);
  const auto passed = [a](double r, double t) { return t * t * a / (1 - r * r * a * a); };
  EXPECT_NEAR(balance(thinner, 0.5).transmitted, (passed(f.Rs, f.Ts) + passed(f.Rp, f.Tp)) / 2, 1e-6);
}

TEST(ThinGlassBsdf, HasNoEventWhereNothingLeaves) {
  const ThinGlassBsdf black{SampledSpectrum(1), ramp(0, 1e4F)};
  for (int hero : {0, kLanes - 1}) {
    const bool leaves = black.sample({0, 0, 1}, {0.5F, {}}, hero, TransportMode::radiance).has_value();
    EXPECT_EQ(delta_probability(Bsdf(black), {0, 0, 1})[hero], leaves ? 1 : 0);
    EXPECT_EQ(leaves, hero == 0);
  }
}

TEST(ThinGlassMaterial, AbsorbsByItsThickness) {
  const ThinGlassMaterial pane{"glass", RefractiveIndex(1.5, 250e-9 / (4 * std::numbers::pi)), 2};
  const SampledSpectrum wavelengths(500);
  EXPECT_NEAR(balance(pane.bsdf({wavelengths}), 1).transmitted, 0.33911112, 1e-5);
}

TEST(ThinGlassBsdf, KeepsAllLanesTogether) {
  const ThinGlassBsdf sheet{ramp(1.45F, 1.9F), ramp(0, 2)};
  const auto s = sheet.sample(direction(0.7, 1), {0.9F, {}}, 2, TransportMode::radiance);
  ASSERT_TRUE(s);
  EXPECT_FALSE(s->dispersive);
  for (int j = 0; j < kLanes; ++j) {
    const Balance own = balance(sheet, 0.7, j);
    EXPECT_NEAR(s->weight[j] * s->pdf, own.transmitted, 1e-6);
    EXPECT_NEAR(s->lane_pdf[j] * s->pdf, own.transmitted / (own.transmitted + own.reflected), 1e-6);
  }
}

TEST(MirrorBsdf, ReflectsTheSameAtEveryAngle) {
  const MirrorBsdf mirror{ramp(0, 0.8F)};
  for (const double cosine : {1.0, 0.01, -0.5}) {
    const V3f wo = direction(cosine, 1);
    const auto s = mirror.sample(wo, {0.5F, {}}, 0, TransportMode::radiance);
    ASSERT_TRUE(s && s->delta);
    for (int j = 0; j < kLanes; ++j) EXPECT_EQ(s->weight[j], mirror.reflectance[j]);
    EXPECT_EQ(s->wi, V3f(-wo.x, -wo.y, wo.z));
  }
}

TEST(SchlickBsdf, IsTheNamedApproximation) {
  const auto s = SchlickBsdf{SampledSpectrum(0.04F)}.sample(direction(0.5, 0), {}, 0, TransportMode::power);
  ASSERT_TRUE(s && s->delta);
  EXPECT_NEAR(s->weight[0], 0.07, 1e-6);
}

// The figure in docs/reference/materials.md: the largest error over all wavelengths and angles.
TEST(SchlickBsdf, IsOffByTheFigureOfTheDocsForAluminium) {
  const RefractiveIndex aluminium = index_of("Al_Rakic");
  double largest = 0;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    for (int degrees = 0; degrees <= 90; ++degrees) {
      const auto exact = [&](double cos_i) {
        return fresnel_conductor(cos_i, aluminium.n(nm), aluminium.k(nm)).R();
      };
      const double cos_i = std::cos(degrees * kDegree);
      largest = std::max(largest, std::abs(schlick(cos_i, exact(1)) - exact(cos_i)));
    }
  EXPECT_NEAR(largest, 0.19, 0.005);
}

}  // namespace
}  // namespace abbe

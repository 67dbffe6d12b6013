#include <gtest/gtest.h>

#include "materials/interface/fresnel.h"
#include "tests/angles.h"
#include "tests/materials/bsdf_examples.h"
#include "tests/materials/hemisphere.h"

namespace abbe {
namespace {

using Imath::V3f;

TEST(PrincipledBsdf, HasBurleysDiffuseGround) {
  const Principled matte(PrincipledParameters{.roughness = 1, .specular = 0});
  const PrincipledBsdf bsdf{SampledSpectrum(0.5F), &matte};
  const V3f normal(0, 0, 1);
  const V3f wi = direction(0.2, 0);
  const double cos2_d = (1 + 0.2) / 2;  // of half the angle between the directions
  const double more = 2 * cos2_d - 0.5;
  EXPECT_NEAR(bsdf.eval(normal, wi, TransportMode::radiance)[0], 0.5 / kPi * (1 + more * std::pow(0.8, 5)),
              1e-5);
}

TEST(PrincipledBsdf, MetalsReflectTheirColour) {
  const Principled metal(PrincipledParameters{.metallic = 1, .roughness = 0.3F});
  const PrincipledBsdf bsdf{ramp(0.2F, 1), &metal};
  for (const int lane : {0, 3, kLanes - 1})
    EXPECT_NEAR(spread_reflectance(bsdf, V3f(0, 0, 1), lane), 0.99 * bsdf.base[lane], 2e-3)
        << "some is lost among facets";
}

TEST(PrincipledBsdf, WhatIsNoMetalReflectsByFresnel) {
  const Principled glossy(PrincipledParameters{.roughness = 0.3F});
  const PrincipledBsdf black{SampledSpectrum(0), &glossy};
  const double cosine = 0.6;
  EXPECT_NEAR(spread_reflectance(black, direction(cosine, 0)), fresnel_dielectric(cosine, 1.5).R(), 3e-3);
}

TEST(PrincipledBsdf, KnowsHowMuchLeaves) {
  const Principled look(PrincipledParameters{
      .metallic = 0.3F, .roughness = 0.7F, .sheen = 0.5F, .clearcoat = 1, .clearcoat_gloss = 0});
  for (const double cosine : {1.0, 0.5, 0.15}) {
    const V3f from = direction(cosine, 0);
    const Principled::Terms known = look.albedo(static_cast<float>(cosine));
    const auto part = [&](auto which) {
      return integral_over_cosines(
          [&](const V3f& to) { return static_cast<double>(which(look.unlimited(from, to))); });
    };
    EXPECT_NEAR(known.white, part([](const auto& p) { return p.white; }), 2e-3);
    EXPECT_NEAR(known.coloured, part([](const auto& p) { return p.coloured; }), 2e-3);
  }
}

// A white cloth would have an albedo of 1.5 at grazing angles, so it is limited. A material that conserves
// energy by itself is unchanged.
TEST(PrincipledBsdf, IsLimitedWhereItWouldMakeLight) {
  const Principled cloth(PrincipledParameters{.roughness = 1, .sheen = 1});
  const Principled::Terms grazing = cloth.albedo(0.1F);
  EXPECT_GT(grazing.white + grazing.coloured, 1.4);
  const PrincipledBsdf white{SampledSpectrum(1), &cloth};
  for (const double cosine : {1.0, 0.7, 0.4, 0.2, 0.1})
    EXPECT_LE(spread_reflectance(white, direction(cosine, 0)), 1 + 1e-3);
  const PrincipledBsdf dark{SampledSpectrum(0.1F), &cloth};
  const V3f a = direction(0.8, 0);
  const V3f b = direction(0.6, 2);
  const Principled::Terms f = cloth.unlimited(a, b);
  EXPECT_FLOAT_EQ(dark.eval(a, b, TransportMode::radiance)[0], f.white + 0.1F * f.coloured);
}

}  // namespace
}  // namespace abbe

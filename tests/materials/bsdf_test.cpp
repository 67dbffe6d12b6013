#include "materials/bsdf.h"

#include <gtest/gtest.h>

#include "materials/bsdf/warp.h"
#include "tests/materials/bsdf_examples.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3f;

TEST(DiffuseBsdf, WeighsEveryDirectionByItsReflectance) {
  const DiffuseBsdf bsdf{ramp(0, 0.8F)};
  const auto s = bsdf.sample(V3f(0, 0, -1), {0, {0.2F, 0.7F}}, 0, TransportMode::radiance);
  ASSERT_TRUE(s);
  EXPECT_LT(s->wi.z, 0);
  for (int j = 0; j < kLanes; ++j) EXPECT_EQ(s->weight[j], bsdf.reflectance[j]);
}

TEST(ConductorBsdf, ReflectsEachLaneByItsFresnelReflectance) {
  const ConductorBsdf bsdf{SampledSpectrum(1.0152F), SampledSpectrum(6.6273F)};
  const auto s = bsdf.sample(direction_at(0.5, 1), {0.9F, {}}, 0, TransportMode::radiance);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->weight[0], 0.900335, 1e-6);
  EXPECT_EQ(s->lane_pdf[5], 1);
}

TEST(Warp, KeepsTheDiscRoundAndItsCentre) {
  EXPECT_EQ(concentric_disc({0.5F, 0.5F}), V2f(0, 0));
  for (int i = 0; i < 100; ++i) {
    const auto edge = static_cast<float>(i) / 100;
    EXPECT_NEAR(concentric_disc({edge, 0}).length(), 1, 1e-6);
    EXPECT_NEAR(concentric_disc({1, edge}).length(), 1, 1e-6);
  }
  for (const V2f& diagonal : {V2f(0.8F, 0.8F), V2f(0.2F, 0.8F), V2f(0.2F, 0.2F), V2f(0.8F, 0.2F)}) {
    const V2f step(1e-4F, 0);
    EXPECT_LT((concentric_disc(diagonal + step) - concentric_disc(diagonal - step)).length(), 1e-3);
  }
  const V3f w = cosine_hemisphere({0.9F, 0.25F});
  EXPECT_NEAR(w.length(), 1, 1e-6);
}

}  // namespace
}  // namespace abbe

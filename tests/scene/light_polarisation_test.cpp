#include <gtest/gtest.h>

#include <cmath>

#include "scene/lights/light.h"

namespace abbe {
namespace {

using Imath::V3f;

Light lamp(std::optional<LightPolarisation> polarisation) {
  return {"lamp", PointLight{}, ScaledCurve(Curve(1.0)), std::move(polarisation)};
}

TEST(LightPolarisation, IsNoneOfAnOrdinaryLamp) {
  EXPECT_FALSE(polarisation_of(lamp({}), {0, 0, 1}));
}

TEST(LightPolarisation, LiesAlongTheAxisAcrossTheWay) {
  const Light light = lamp(LightPolarisation{0.75F, LinearPolarisation{{0, 0, 1}}});
  const V3f way = V3f(1, 2, 2) / 3;
  const auto seen = polarisation_of(light, way);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->axis.length(), 1, 1e-6F);
  EXPECT_NEAR(seen->axis.dot(way), 0, 1e-6F);
  EXPECT_GT(seen->axis.z, 0);
  EXPECT_NEAR(seen->axis.dot(way.cross(V3f(0, 0, 1))), 0, 1e-6F) << "in the plane of the axis and the way";
  EXPECT_EQ(seen->q, 0.75F);
  EXPECT_EQ(seen->u, 0);
  EXPECT_EQ(seen->v, 0);
  EXPECT_FALSE(polarisation_of(light, {0, 0, -1}));
}

TEST(LightPolarisation, TurnsRightOrLeft) {
  for (const bool right : {false, true}) {
    const auto seen =
        polarisation_of(lamp(LightPolarisation{0.5F, CircularPolarisation{right}}), {0, 0.6F, -0.8F});
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->axis.length(), 1, 1e-6F);
    EXPECT_NEAR(seen->axis.dot({0, 0.6F, -0.8F}), 0, 1e-6F);
    EXPECT_EQ(seen->q, 0);
    EXPECT_EQ(seen->v, right ? 0.5F : -0.5F);
  }
}

}  // namespace
}  // namespace abbe

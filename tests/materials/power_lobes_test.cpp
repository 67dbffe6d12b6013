#include <gtest/gtest.h>

#include "tests/angles.h"
#include "tests/materials/bsdf_examples.h"
#include "tests/materials/hemisphere.h"

namespace abbe {
namespace {

using Imath::V3f;
const SampledSpectrum kWhite(1);

// Energy is conserved up to C = 1/pi for the one-sided lobe and up to C = (a + 2)/(2 pi) for the reciprocal
// one. A reflectance of 1 gives these values.
TEST(CosinePowerBsdf, WhiteHasTheLargestConstantThatConservesEnergy) {
  for (const double a : {0.0, 1.0, 4.5}) {
    const auto exponent = static_cast<float>(a);
    const V3f normal(0, 0, 1);
    EXPECT_NEAR((CosinePowerBsdf<false>{kWhite, exponent}.eval(normal, normal, TransportMode::power)[0]),
                1 / kPi, 1e-6);
    EXPECT_NEAR((CosinePowerBsdf<true>{kWhite, exponent}.eval(normal, normal, TransportMode::power)[0]),
                (a + 2) / (2 * kPi), 1e-6);
    for (const double cosine : {1.0, 0.6, 0.1}) {
      const V3f from = direction(cosine, 2);
      EXPECT_NEAR(spread_reflectance(CosinePowerBsdf<false>{kWhite, exponent}, from), std::pow(cosine, a),
                  1e-4);
      EXPECT_NEAR(spread_reflectance(CosinePowerBsdf<true>{kWhite, exponent}, from), std::pow(cosine, a),
                  1e-4);
    }
  }
}

TEST(CosinePowerBsdf, OfOneDirectionTellsWhichWayLightGoes) {
  const CosinePowerBsdf<false> bsdf{kWhite, 2};
  const V3f steep = direction(0.9, 0);
  const V3f flat = direction(0.3, 1);
  EXPECT_NEAR(bsdf.eval(steep, flat, TransportMode::radiance)[0], 0.09 / kPi, 1e-6);
  EXPECT_NEAR(bsdf.eval(flat, steep, TransportMode::power)[0], 0.09 / kPi, 1e-6);
  EXPECT_NEAR(bsdf.eval(steep, flat, TransportMode::power)[0], 0.81 / kPi, 1e-6);
}

// Along the normal the lobe is not cut by the horizon, and its albedo is (n + 1)/(n + 2). Towards grazing
// incidence it grows without bound; the values between are by quadrature.
TEST(PhongBsdf, ReturnsMoreThanArrives) {
  const PhongBsdf phong{kWhite, 10};
  EXPECT_NEAR(spread_reflectance(phong, V3f(0, 0, 1)), 11.0 / 12, 1e-4);
  EXPECT_NEAR(spread_reflectance(phong, direction(0.5, 0)), 0.9254, 1e-3);
  EXPECT_NEAR(spread_reflectance(phong, direction(std::cos(80 * kPi / 180), 0)), 1.2039, 1e-3);
  EXPECT_GT(spread_reflectance(phong, direction(0.001, 0)), 100);
}

TEST(PhongBsdf, CannotBeReversed) {
  const PhongBsdf phong{kWhite, 10};
  const V3f a = direction(0.8, 0);
  const V3f b = direction(0.4, kPi);
  const float forth = phong.eval(a, b, TransportMode::power)[0];
  const float back = phong.eval(b, a, TransportMode::power)[0];
  EXPECT_NEAR(back / forth, 2, 1e-5) << "as the cosines are";
  EXPECT_FLOAT_EQ(phong.eval(b, a, TransportMode::radiance)[0], forth);
}

TEST(RetroreflectorBsdf, ReturnsItsReflectanceAlongTheNormalAndLessElsewhere) {
  for (const float n : {0.0F, 1.0F, 8.0F, 100.0F}) {
    const RetroreflectorBsdf bsdf{SampledSpectrum(0.7F), n};
    const double most = spread_reflectance(bsdf, V3f(0, 0, 1));
    EXPECT_NEAR(most, 0.7, 1e-3);
    double before = most;
    for (const double cosine : {0.95, 0.7, 0.4, 0.1}) {
      const double here = spread_reflectance(bsdf, direction(cosine, 1));
      EXPECT_LT(here, before);
      before = here;
    }
  }
}

TEST(RetroreflectorBsdf, SendsMostBack) {
  const RetroreflectorBsdf bsdf{kWhite, 500};
  const V3f wo = direction(0.6, 0);
  const auto s = bsdf.sample(wo, {0, {0.5F, 0.3F}}, 0, TransportMode::radiance);
  ASSERT_TRUE(s);
  EXPECT_GT(s->wi.dot(wo), 0.995);
  EXPECT_EQ(bsdf.eval(wo, V3f(-wo.x, 0, wo.z), TransportMode::radiance)[0],
            bsdf.eval(wo, V3f(-wo.x, 0, wo.z), TransportMode::power)[0]);
}

}  // namespace
}  // namespace abbe

#include <gtest/gtest.h>

#include "tests/materials/bsdf_examples.h"
#include "tests/materials/hemisphere.h"

namespace abbe {
namespace {

using Imath::V3f;

TEST(OrenNayarBsdf, IsLambertsWithoutRoughness) {
  EXPECT_EQ(oren_nayar_roughness(0), 0);
  const OrenNayarBsdf bsdf{ramp(0, 0.8F), 0};
  for (const double cosine : {1.0, 0.3}) {
    const SampledSpectrum f = bsdf.eval(direction(cosine, 0), direction(0.6, 2), TransportMode::radiance);
    for (int j = 0; j < kLanes; ++j)
      EXPECT_NEAR(f[j], bsdf.reflectance[j] * std::numbers::inv_pi_v<float>, 1e-7);
  }
}

// The shape of the qualitative model of [OrenNayar1994] for the same sigma.
TEST(OrenNayarBsdf, HasTheRatioOfTheQualitativeModel) {
  const double s2 = std::pow(30 * std::numbers::pi / 180, 2);
  const double ratio = 0.45 * s2 / (s2 + 0.09) / (1 - 0.5 * s2 / (s2 + 0.33));
  EXPECT_NEAR(oren_nayar_roughness(30), ratio, 1e-6);
  EXPECT_NEAR(oren_nayar_roughness(30), 0.43821, 1e-5);
}

TEST(OrenNayarBsdf, WhiteMatterReturnsAllFromEveryDirection) {
  for (const double sigma : {5.0, 30.0, 90.0})
    for (const double cosine : {1.0, 0.7, 0.2, 0.1}) {
      const OrenNayarBsdf white{SampledSpectrum(1), oren_nayar_roughness(sigma)};
      EXPECT_NEAR(spread_reflectance(white, direction(cosine, 0.4)), 1, 2e-4) << sigma << " " << cosine;
    }
}

// Light that grey facets scatter repeatedly is multiplied by rho each time. With E the mean single-scattering
// albedo of diffuse light, the diffuse albedo is rho E + rho^2 E (1 - E)/(1 - rho (1 - E)).
TEST(OrenNayarBsdf, GreyMatterLosesWithEachScattering) {
  const float r = 1;
  const double rho = 0.5;
  const double a = 1 / (1 + (0.5 - 2 / (3 * std::numbers::pi)) * r);
  const double once = a * (1 + r * (2.0 / 3 - 28 / (15 * std::numbers::pi)));
  const double expected = rho * once + rho * rho * once * (1 - once) / (1 - rho * (1 - once));
  const OrenNayarBsdf grey{SampledSpectrum(static_cast<float>(rho)), r};
  double mean = 0;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double c = (i + 0.5) / kSteps;
    mean +=
        2 * c *
        integral_over_cosines(
            [&](const V3f& to) { return double(grey.eval(direction(c, 0), to, TransportMode::power)[0]); },
            100) /
        kSteps;
  }
  EXPECT_NEAR(mean, expected, 2e-4);
}

TEST(OrenNayarBsdf, ThrowsLightBack) {
  const OrenNayarBsdf rough{SampledSpectrum(0.5F), oren_nayar_roughness(40)};
  const V3f wo = direction(0.5, 0);
  const float back = rough.eval(wo, wo, TransportMode::radiance)[0];
  const float on = rough.eval(wo, V3f(-wo.x, wo.y, wo.z), TransportMode::radiance)[0];
  EXPECT_GT(back, 1.5F * on);
}

}  // namespace
}  // namespace abbe

// Rough surfaces, from nearly smooth to the largest roughness, from normal to grazing incidence.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "materials/bsdf/rough.h"
#include "materials/bsdf/warp.h"
#include "tests/tier.h"
#include "validation/goniometer/lobes.h"

namespace abbe {
namespace {

// The daytime run has five alphas, five angles and fewer samples.
TEST(Stress, GgxSamplesFollowTheirDensityAtTwentyAlphasAndTenAngles) {
  const int alphas = test::nightly() ? 20 : 5;
  const int angles = test::nightly() ? 10 : 5;
  const int samples = test::nightly() ? 50000 : 20000;
  const double significance = 1 - std::pow(1 - 0.01, 1.0 / (alphas * angles));  // Šidák correction
  const SampledSpectrum wavelengths(550);
  for (int a = 0; a < alphas; ++a) {
    const auto alpha = static_cast<float>(std::pow(10.0, -3 + 3.0 * a / (alphas - 1)));
    const RoughConductorMaterial metal("metal", RefractiveIndex(0.2, 3), {FacetShape::ggx, alpha, alpha});
    const Bsdf bsdf = metal.bsdf({wavelengths});
    for (int i = 0; i < angles; ++i) {
      const double angle = 85.0 * i / (angles - 1) * std::numbers::pi / 180;
      const Imath::V3f wo = direction_at(std::cos(angle), 0.7);
      const DensityCheck check = check_density(
          sampler_of(bsdf, wo, TransportMode::radiance),
          [&](const Imath::V3f& wi) { return static_cast<double>(pdf(bsdf, wo, wi)[0]); }, 0, samples);
      EXPECT_GT(check.p, significance) << "alpha " << alpha << ", step " << i << " to 85 degrees";
      EXPECT_LE(check.integral, 1 + 1e-3) << "alpha " << alpha << ", step " << i;
    }
  }
}

}  // namespace
}  // namespace abbe

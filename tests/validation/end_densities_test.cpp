// Pdfs of both ends of a path, against the samples that they draw.
#include <gtest/gtest.h>

#include "tests/scene/scenes.h"
#include "validation/goniometer/lobes.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3f;

constexpr double kSignificance = 1e-4;
const SampledSpectrum kWavelengths(550);

// A direction as a BSDF sample for the goniometer.
BsdfSample as_event(const V3f& direction) {
  BsdfSample event;
  event.wi = direction;
  return event;
}

void expect_drawn_by(const LobeSampler& sampler, const SphereDensity& density, double integral) {
  const DensityCheck check = check_density(sampler, density, 0);
  EXPECT_NEAR(check.integral, integral, 2e-4);
  EXPECT_GT(check.p, kSignificance);
}

TEST(EndDensities, DirectionsOfAMeter) {
  const Camera meter{IrradianceProbe{Quad{{1, 1, 1}, {2, 0, 0}, {1, 4, 0}}}, 6, 4, 0.005};
  const V2f film(2.5F, 1.5F);
  const auto ray = [&](V2f u) { return sample_ray(meter, film, u, kWavelengths, 0, 0).ray; };
  const V3f from = ray({0.5F, 0.5F}).origin;
  expect_drawn_by([&](const BsdfRandom& u, int) { return as_event(ray(u.direction).direction); },
                  [&](const V3f& w) {
                    const auto of = density(meter, {from, w}, kWavelengths);
                    return of ? static_cast<double>(of->pdf_direction[5]) : 0.0;
                  },
                  1);
}

}  // namespace
}  // namespace abbe

#include "transport/path/mis_weight.h"

#include <gtest/gtest.h>

namespace abbe {
namespace {

// Pdfs of a direction by scattering, P_k s_k, and by connection, c sum_k P_k, for eight wavelengths.
struct Densities {
  SampledSpectrum scattered;
  float connection_pdf;
  float connected;
};
std::vector<Densities> some_densities() {
  SampledSpectrum::Values uneven{};
  for (std::size_t k = 0; k < kLanes; ++k) uneven[k] = 0.1F * static_cast<float>(k * k);
  return {{SampledSpectrum(0.5F), 0.2F, 8},
          {SampledSpectrum(uneven), 3, 2.5F},
          {SampledSpectrum(uneven), 1e-3F, 7}};
}

TEST(LightWeights, AddUpToOneOverLanesAndWays) {
  for (const Densities& p : some_densities())
    for (const PathSampling& sampling :
         {PathSampling{}, PathSampling{.heuristic = MisHeuristic::power},
          PathSampling{.lights = LightStrategy::bsdf}, PathSampling{.lights = LightStrategy::light}}) {
      const LightWeights weights(sampling);
      float sum = 0;
      for (int k = 0; k < kLanes; ++k)
        sum += weights.emission_weight(p.scattered, p.connection_pdf, p.connected) * p.scattered[k];
      if (weights.connects())
        sum += weights.connection_weight(p.scattered, p.connection_pdf, p.connected) * p.connection_pdf *
               p.connected;
      EXPECT_NEAR(sum, 1, 1e-6);
    }
}

TEST(LightWeights, OfThePowerHeuristicAreAsTheSquares) {
  const LightWeights weights(PathSampling{.heuristic = MisHeuristic::power});
  for (const Densities& p : some_densities()) {
    const double s = p.scattered.sum();
    const double c = double{p.connection_pdf} * p.connected;
    EXPECT_NEAR(weights.emission_weight(p.scattered, p.connection_pdf, p.connected) * s,
                s * s / (s * s + c * c), 1e-6);
    EXPECT_NEAR(weights.connection_weight(p.scattered, p.connection_pdf, p.connected) * c,
                c * c / (s * s + c * c), 1e-6);
  }
}

// Emission that no connection could have sampled, as after a delta event, counts as an emitter hit.
TEST(LightWeights, OfConnectionsAloneLeaveWhatTheyCannotDraw) {
  const LightWeights weights(PathSampling{.lights = LightStrategy::light});
  EXPECT_EQ(weights.emission_weight(SampledSpectrum(0.5F), 0, 0), 0.25F);
  EXPECT_EQ(weights.emission_weight(SampledSpectrum(0.5F), 0.1F, 8), 0);
}

}  // namespace
}  // namespace abbe

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "transport/path/vertex.h"

namespace abbe {
namespace {

Medium medium() {
  SampledSpectrum::Values absorption;
  absorption.fill(2);
  absorption[3] = 0;
  return {true, SampledSpectrum(absorption)};
}

TEST(Medium, AttenuatesByBeersLaw) {
  SampledSpectrum lanes(0.5F);
  medium().attenuate(lanes, 0.25F);
  EXPECT_FLOAT_EQ(lanes[0], 0.5F * std::exp(-0.5F));
  EXPECT_EQ(lanes[3], 0.5F);
}

TEST(Medium, AttenuatesPreciselyAtAnyDepth) {
  for (float depth = 0; depth < 87; depth += 0.0137F) {
    SampledSpectrum lanes(1.0F);
    Medium{true, SampledSpectrum(1.0F)}.attenuate(lanes, depth);
    const double expected = std::exp(-static_cast<double>(depth));
    ASSERT_NEAR(lanes[5], expected, 3e-7 * expected) << depth;
  }
  SampledSpectrum lanes(1.0F);
  Medium{true, SampledSpectrum(1.0F)}.attenuate(lanes, 88);
  EXPECT_EQ(lanes[5], 0);
}

TEST(Medium, AnInfiniteWayLeavesWhatIsNotAbsorbed) {
  SampledSpectrum lanes(0.5F);
  medium().attenuate(lanes, std::numeric_limits<float>::infinity());
  EXPECT_EQ(lanes[0], 0);
  EXPECT_EQ(lanes[3], 0.5F);
}

}  // namespace
}  // namespace abbe

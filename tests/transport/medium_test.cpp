#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "transport/path/vertex.h"

namespace abbe {
namespace {

Medium medium() {
  Medium m{true, SampledSpectrum(2.0F)};
  m.absorption_per_m[3] = 0;
  return m;
}

TEST(Medium, AttenuatesByBeersLaw) {
  SampledSpectrum lanes(0.5F);
  medium().attenuate(lanes, 0.25F);
  EXPECT_FLOAT_EQ(lanes[0], 0.5F * std::exp(-0.5F));
  EXPECT_EQ(lanes[3], 0.5F);
}

TEST(Medium, AnInfiniteWayLeavesWhatIsNotAbsorbed) {
  SampledSpectrum lanes(0.5F);
  medium().attenuate(lanes, std::numeric_limits<float>::infinity());
  EXPECT_EQ(lanes[0], 0);
  EXPECT_EQ(lanes[3], 0.5F);
}

}  // namespace
}  // namespace abbe

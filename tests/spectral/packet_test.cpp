#include "spectral/sampled_spectrum.h"

#include <gtest/gtest.h>

#include <limits>

namespace abbe {
namespace {

SampledSpectrum counting() {
  SampledSpectrum::Values values;
  for (std::size_t i = 0; i < kLanes; ++i) values[i] = static_cast<float>(i + 1);
  return SampledSpectrum(values);
}

TEST(SampledSpectrum, FoldsEveryLaneOnce) {
  EXPECT_EQ(counting().sum(), kLanes * (kLanes + 1) / 2.0F);
  EXPECT_EQ(counting().mean(), (kLanes + 1) / 2.0F);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ((counting() + SampledSpectrum::only(lane, 100)).max(), counting()[lane] + 100);
    EXPECT_FALSE(SampledSpectrum::only(lane, -1e-30F).is_zero()) << lane;
    const SampledSpectrum nan = SampledSpectrum::only(lane, std::numeric_limits<float>::quiet_NaN());
    EXPECT_TRUE(nan.has_nan()) << lane;
    EXPECT_FALSE(nan.is_zero()) << lane;
  }
  EXPECT_EQ((counting() * -1).max(), -1);
  EXPECT_TRUE((counting() * 0).is_zero());
  EXPECT_TRUE((counting() * -0.0F).is_zero());
  EXPECT_FALSE((counting() * std::numeric_limits<float>::infinity()).has_nan());
}

TEST(SampledSpectrum, ActsLaneByLane) {
  const SampledSpectrum a = counting();
  const SampledSpectrum b(2.0F);
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto x = static_cast<float>(lane + 1);
    EXPECT_EQ((a + b)[lane], x + 2);
    EXPECT_EQ((b - a)[lane], 2 - x);
    EXPECT_EQ((a * b)[lane], x * 2);
    EXPECT_EQ((a / b)[lane], x / 2);
    EXPECT_EQ((3 * a)[lane], 3 * x);
    EXPECT_EQ(a.values()[static_cast<std::size_t>(lane)], x);
    EXPECT_EQ(SampledSpectrum::map(a, b, [](float p, float q) { return p - 2 * q; })[lane], x - 4);
  }
}

}  // namespace
}  // namespace abbe

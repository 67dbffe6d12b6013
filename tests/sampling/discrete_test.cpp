#include "sampling/discrete.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace abbe {
namespace {

TEST(Discrete, StepsAreFoundWhereTheyBegin) {
  const std::array<double, 3> cdf{0.25, 0.5, 1};
  const std::span<const double> view(cdf);
  EXPECT_EQ(invert_cdf(view, 0.0).index, 0U);
  EXPECT_EQ(invert_cdf(view, 0.25).index, 1U);
  EXPECT_EQ(invert_cdf(view, 0.25).within, 0);
  EXPECT_EQ(invert_cdf(view, 0.375).within, 0.5);
  EXPECT_EQ(invert_cdf(view, 0.75).index, 2U);
  EXPECT_EQ(invert_cdf(view, 0.75).within, 0.5);
}

TEST(Discrete, StepsOfNoProbabilityAreNeverFound) {
  const std::array<float, 5> cdf{0, 0.5F, 0.5F, 0.999F, 0.999F};  // a sum rounded to below 1
  const std::span<const float> view(cdf);
  for (const double u : {0.0, 0.4999, 0.5, 0.9989, 0.9995, std::nextafter(1.0, 0.0)}) {
    const CdfStep<double> step = invert_cdf(view, u);
    EXPECT_GT(cdf_step(view, step.index), 0) << u;
    EXPECT_GE(step.within, 0) << u;
    EXPECT_LE(step.within, 1) << u;
  }
  EXPECT_EQ(invert_cdf(view, 0.9995).index, 3U);
  EXPECT_EQ(invert_cdf(view, 0.0).index, 1U);
}

/// Evenly spaced numbers select each step in proportion to its weight, and leave evenly spaced positions
/// inside it.
TEST(Discrete, FrequenciesFollowTheWeights) {
  const std::array weights{3.0, 0.0, 1.0, 4.0};
  std::vector<double> cdf;
  for (const double weight : weights) cdf.push_back(weight + (cdf.empty() ? 0 : cdf.back()));
  normalise_cdf(std::span(cdf));
  EXPECT_EQ(cdf.back(), 1);
  constexpr int kNumbers = 8000;
  std::array<int, 4> found{};
  std::array<double, 4> sum{};
  for (int i = 0; i < kNumbers; ++i) {
    const auto [index, within] = invert_cdf(std::span<const double>(cdf), (i + 0.5) / kNumbers);
    ++found.at(index);
    sum.at(index) += within;
  }
  for (std::size_t k = 0; k < weights.size(); ++k) {
    EXPECT_EQ(found.at(k), std::lround(kNumbers * weights.at(k) / 8)) << k;
    if (found.at(k) > 0) {
      EXPECT_NEAR(sum.at(k) / found.at(k), 0.5, 1e-9) << k;
    }
  }
}

TEST(Discrete, SumsOfNothingStay) {
  std::vector<double> sums{0, 0};
  normalise_cdf(std::span(sums));
  EXPECT_EQ(sums, (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace abbe

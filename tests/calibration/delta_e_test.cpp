#include "calibration/chart/delta_e.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include <random>

#include "io/table.h"
#include "spectral/colorimetry.h"

namespace abbe {
namespace {

using Jet = ceres::Jet<double, 3>;

// The difference as a function of the second colour, with its derivatives.
Jet differentiated(const Lab& first, const Lab& second) {
  const std::array<Jet, 3> a{Jet(first[0]), Jet(first[1]), Jet(first[2])};
  const std::array<Jet, 3> b{Jet(second[0], 0), Jet(second[1], 1), Jet(second[2], 2)};
  return delta_e_2000(a, b);
}

// The 34 published pairs, which reach every branch of the formula [Sharma2005].
TEST(DeltaE2000, SharmasPairsAreThePublishedOnes) {
  const ReferenceTable table("ciede2000_sharma2005");
  ASSERT_EQ(table.rows(), 34U);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Lab first{table.number(row, "L1"), table.number(row, "a1"), table.number(row, "b1")};
    const Lab second{table.number(row, "L2"), table.number(row, "a2"), table.number(row, "b2")};
    EXPECT_NEAR(delta_e_2000(first, second), table.number(row, "dE00"), 5.1e-5) << table.text(row, "pair");
    EXPECT_NEAR(delta_e_2000(second, first), table.number(row, "dE00"), 5.1e-5) << table.text(row, "pair");
  }
}

TEST(DeltaE2000, DerivativesAgreeWithFiniteDifferences) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> lightness(5, 95);
  std::uniform_real_distribution<double> opponent(-60, 60);
  std::uniform_real_distribution<double> step(-8, 8);
  for (int i = 0; i < 500; ++i) {
    const Lab first{lightness(random), opponent(random), opponent(random)};
    const Lab second{first[0] + step(random), first[1] + step(random), first[2] + step(random)};
    const Jet d = differentiated(first, second);
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr double kStep = 1e-5;
      Lab low = second;
      Lab high = second;
      low[k] -= kStep;
      high[k] += kStep;
      const double slope = (delta_e_2000(first, high) - delta_e_2000(first, low)) / (2 * kStep);
      EXPECT_NEAR(d.v[static_cast<Eigen::Index>(k)], slope, 1e-5 * (1 + std::abs(slope)))
          << testing::PrintToString(first) << " to " << testing::PrintToString(second);
    }
  }
}

TEST(DeltaE2000, DerivativesAreFiniteWhereTheFormulaIsNot) {
  const Lab colors[] = {{50, 0, 0}, {50, 20, -30}, {0, 0, 0}, {100, 0, 0}, {50, -20, 30}, {50, 0, 10}};
  for (const Lab& first : colors)
    for (const Lab& second : colors) {
      const Jet d = differentiated(first, second);
      EXPECT_TRUE(d.v.allFinite()) << testing::PrintToString(first) << " to "
                                   << testing::PrintToString(second);
      EXPECT_EQ(d.a == 0, first == second);
    }
}

TEST(DeltaE2000, VectorIsSmoothAtZeroDifference) {
  const Lab color{60, 12, -35};
  const std::array<Jet, 3> a{Jet(color[0]), Jet(color[1]), Jet(color[2])};
  const std::array<Jet, 3> b{Jet(color[0], 0), Jet(color[1], 1), Jet(color[2], 2)};
  const std::array<Jet, 3> d = delta_e_2000_vector(a, b);
  Eigen::Matrix3d jacobian;
  for (int k = 0; k < 3; ++k) jacobian.row(k) = d[static_cast<std::size_t>(k)].v;
  EXPECT_GT(std::abs(jacobian.determinant()), 0.05);
}

TEST(DeltaE94, FollowsTheFormulaOnPureChromaAndPureHue) {
  EXPECT_NEAR(delta_e_94(Lab{50, 50, 0}, Lab{50, 60, 0}), 10 / 3.25, 1e-12);
  EXPECT_NEAR(delta_e_94(Lab{50, 50, 0}, Lab{50, 0, 50}), std::sqrt(5000) / 1.75, 1e-12);
  EXPECT_NEAR(delta_e_94(Lab{40, 0, 0}, Lab{47, 0, 0}), 7, 1e-12);
  EXPECT_NE(delta_e_94(Lab{50, 60, 0}, Lab{50, 50, 0}), delta_e_94(Lab{50, 50, 0}, Lab{50, 60, 0}));
}

}  // namespace
}  // namespace abbe

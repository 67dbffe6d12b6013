#include "materials/index/dispersion.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>

namespace abbe {
namespace {

DispersionFormula formula(int id, std::initializer_list<double> c) {
  DispersionFormula f{.id = id, .c = {}, .terms = static_cast<int>(c.size())};
  std::copy(c.begin(), c.end(), f.c.begin());
  return f;
}

// One formula of every kind, with realistic coefficients.
const DispersionFormula kAll[] = {
    formula(1, {0, 0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161}),
    formula(2, {0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653}),
    formula(3, {2.7324621, -0.01249046, 2, 0.018562334, -2, 0.00099990536, -4}),
    formula(4, {8.393, 0.14383, 0, 0.2421, 2, 4430.99, 0, 36.71, 2, 0.01, 2}),
    formula(5, {1.5, 0.0042, -2, 0.0001, -4}),
    formula(6, {0, 0.05792105, 238.0185, 0.00167917, 57.362}),
    formula(7, {1.45, 0.01, -0.0002, -0.003, 0.0001, -0.00001}),
    formula(8, {0.2, 0.05, 0.03, -0.002}),
    formula(9, {2.3, 0.02, 0.02, 0.01, 1.5, 1}),
};

// The documented formulas written out at L = 0.6 um.
TEST(Dispersion, FollowsTheTableOfFormulas) {
  const double L = 0.6, L2 = L * L;
  const double expected[] = {
      std::sqrt(1 + 0.6961663 * L2 / (L2 - 0.0684043 * 0.0684043) +
                0.4079426 * L2 / (L2 - 0.1162414 * 0.1162414) + 0.8974794 * L2 / (L2 - 9.896161 * 9.896161)),
      std::sqrt(1 + 1.03961212 * L2 / (L2 - 0.00600069867) + 0.231792344 * L2 / (L2 - 0.0200179144) +
                1.01046945 * L2 / (L2 - 103.560653)),
      std::sqrt(2.7324621 - 0.01249046 * L2 + 0.018562334 / L2 + 0.00099990536 / (L2 * L2)),
      std::sqrt(8.393 + 0.14383 / (L2 - 0.2421 * 0.2421) + 4430.99 / (L2 - 36.71 * 36.71) + 0.01 * L2),
      1.5 + 0.0042 / L2 + 0.0001 / (L2 * L2),
      1 + 0.05792105 / (238.0185 - 1 / L2) + 0.00167917 / (57.362 - 1 / L2),
      1.45 + 0.01 / (L2 - 0.028) - 0.0002 / std::pow(L2 - 0.028, 2) - 0.003 * L2 + 0.0001 * L2 * L2 -
          0.00001 * std::pow(L, 6),
      0,
      std::sqrt(2.3 + 0.02 / (L2 - 0.02) + 0.01 * (L - 1.5) / ((L - 1.5) * (L - 1.5) + 1))};
  for (const DispersionFormula& f : kAll) {
    const double n = dispersion_index(f, L);
    if (f.id == 8)
      EXPECT_NEAR((n * n - 1) / (n * n + 2), 0.2 + 0.05 * L2 / (L2 - 0.03) - 0.002 * L2, 1e-15);
    else
      EXPECT_NEAR(n, expected[f.id - 1], 1e-15) << "formula " << f.id;
  }
}

TEST(Dispersion, LeavesOutAbsentTerms) {
  const DispersionFormula constant = formula(4, {2.25});
  EXPECT_EQ(dispersion_index(constant, 1.0), 1.5);  // an absent resonance 0/(L^2 - 0^0) would be 0/0
  DispersionFormula padded = formula(5, {1.5, 0.0042, -2});
  padded.terms = 17;
  EXPECT_EQ(dispersion_index(padded, 0.5), 1.5 + 0.0042 / 0.25);
}

TEST(Dispersion, HasNoIndexWhereItsSquareIsNegative) {
  EXPECT_TRUE(std::isnan(dispersion_index(formula(3, {-1.0}), 0.5)));
  EXPECT_TRUE(std::isnan(dispersion_index(formula(12, {1.5}), 0.5)));
}

TEST(Dispersion, DifferentiatesWithDualNumbers) {
  using Jet = ceres::Jet<double, 1>;
  for (const DispersionFormula& f : kAll) {
    const double L = 0.55, h = 1e-5;
    const double slope = (dispersion_index(f, L + h) - dispersion_index(f, L - h)) / (2 * h);
    EXPECT_NEAR(dispersion_index(f, Jet(L, 0)).v[0], slope, 1e-8) << "formula " << f.id;
  }
}

TEST(Dispersion, AcceptsFloat) {
  for (const DispersionFormula& f : kAll)
    EXPECT_NEAR(dispersion_index(f, 0.55F), dispersion_index(f, double(0.55F)), 1e-6) << "formula " << f.id;
}

TEST(Dispersion, FindsResonancesInsideTheRange) {
  for (const DispersionFormula& f : kAll) EXPECT_EQ(dispersion_fault(f, 400, 1000), std::nullopt) << f.id;
  const DispersionFormula bad[] = {formula(1, {0, 1, 0.5}),         formula(2, {0, 1, 0.25}),
                                   formula(4, {2, 0.1, 0, 0.5, 2}), formula(6, {0, 0.05, 4}),
                                   formula(8, {0.2, 1e-6, 0.25}),   formula(9, {2, 0.02, 0.25})};
  for (const DispersionFormula& f : bad) {
    const auto fault = dispersion_fault(f, 400, 1000);
    ASSERT_TRUE(fault) << f.id;
    EXPECT_NE(fault->find("resonance at 500 nm"), std::string::npos) << *fault;
    EXPECT_EQ(dispersion_fault(f, 501, 1000), std::nullopt) << f.id;
    EXPECT_NE(dispersion_fault(f, 500.1, 1000), std::nullopt) << "within the margin, formula " << f.id;
  }
  EXPECT_NE(dispersion_fault(formula(7, {1.5, 0.01}), 150, 1000), std::nullopt);
}

TEST(Dispersion, FindsIndicesBelowOne) {
  const auto fault = dispersion_fault(formula(5, {0.9, 0.05, -2}), 400, 1000);
  ASSERT_TRUE(fault);
  EXPECT_EQ(*fault, "dispersion formula 5 gives n = 0.999748 at 708 nm (allowed above 1)");
}

}  // namespace
}  // namespace abbe

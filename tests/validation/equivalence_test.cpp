#include "validation/statistics/equivalence.h"

#include <gtest/gtest.h>

#include "validation/cases/case.h"

namespace abbe {
namespace {

TEST(Equivalence, PassesOnlyWithTheWholeIntervalInside) {
  EXPECT_EQ(equivalence({1.001, 0.001}, 1, 0.01), Verdict::pass);
  EXPECT_EQ(equivalence({1.001, 0.002}, 1, 0.01), Verdict::inconclusive);
  EXPECT_EQ(equivalence({1.02, 0.001}, 1, 0.01), Verdict::fail);
}

TEST(Equivalence, ABiasWithinTheMarginStillFailsOnceItIsCertain) {
  EXPECT_EQ(equivalence({1.0099, 0.0001}, 1, 0.01), Verdict::fail);
}

TEST(Equivalence, NoNumberFails) {
  EXPECT_EQ(equivalence({0.0 / 0.0, 0.001}, 1, 0.01), Verdict::fail);
}

// The closed forms themselves, against published or independently computed figures.
TEST(Cases, ExpectedValuesAreTheKnownFigures) {
  const auto expected = [](const std::string& title) {
    for (const Case& item : radiometry_cases())
      if (item.title.find(title) != std::string::npos) return item.expected;
    return 0.0;
  };
  EXPECT_NEAR(expected("reflectance 0.5: mean"), 104.16667 * 2, 1e-4);
  EXPECT_NEAR(expected("centre of a wall"), 198.94368, 1e-5);
  EXPECT_NEAR(expected("at a corner"), 38.28673, 1e-5);
  const double pi = 3.14159265358979;
  EXPECT_NEAR(expected("under its corner") / pi, 0.13853161, 1e-8);
  EXPECT_NEAR(expected("under its centre") / pi, 0.23945647, 1e-8);
  EXPECT_NEAR(expected("above the receiver's horizon") / pi, 0.05573420, 1e-8);
  EXPECT_NEAR(expected("on its axis") / pi, 0.5, 1e-12);
  EXPECT_NEAR(expected("off its axis") / pi, 0.06587843, 1e-8);
  EXPECT_NEAR(expected("at most 4 vertices") / pi, 0.5904, 1e-12);
  EXPECT_NEAR(expected("plate along its normal") * 4 / pi, 0.92307692, 1e-5);
  EXPECT_NEAR(expected("plate at 60 degrees") * 4 / pi, 0.836232, 1e-5);
  EXPECT_NEAR(expected("absorbing plate, transmitted") * 4 / pi, 0.33911112, 1e-5);
  EXPECT_NEAR(expected("absorbing plate, reflected") * 4 / pi, 0.04499008, 1e-5);
}

}  // namespace
}  // namespace abbe

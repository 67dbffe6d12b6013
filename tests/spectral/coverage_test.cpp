#include "spectral/library.h"

#include <gtest/gtest.h>

#include <array>

#include "spectral/colorimetry.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

TEST(Coverage, TheShareBeyondIsOfTheMagnitude) {
  EXPECT_NEAR(fraction_outside(Curve(2), Curve(1.0), 380, 780).fraction, 0.5, 1e-12);
  EXPECT_NEAR(fraction_outside(Curve(2), Curve(1.0), 300, 1100).fraction, 0, 1e-12);
  const Curve both = sum(band(400, 500, -1), band(500, 600, 1));
  EXPECT_NEAR(fraction_outside(both, Curve(1.0), 300, 525).fraction, 0.375, 1e-12);
  EXPECT_EQ(fraction_outside(Curve(), Curve(1.0), 400, 500).fraction, 0);
}

// One eighth of x^2 on [0, 1] lies below 1/2, also if the light continues outside the weight.
TEST(Coverage, TheShareBeyondIsOfWhatIsCountedOfALight) {
  const Curve weight({{400, 0}, {500, 1}, {500, 0}});
  const Curve light({{400, 0}, {1100, 7}});
  EXPECT_NEAR(fraction_outside(weight, light, 300, 450).fraction, 0.875, 1e-12);
  EXPECT_NEAR(fraction_outside(weight, light, 450, 1100).fraction, 0.125, 1e-12);
  EXPECT_NEAR(fraction_outside(light, weight, 450, 1100).fraction, 0.125, 1e-12);
  EXPECT_EQ(fraction_outside(weight, light, 600, 1100).fraction, 1);
  EXPECT_EQ(fraction_outside(weight, light, 400, 500).fraction, 0);
  EXPECT_EQ(fraction_outside(weight, band(600, 700), 300, 450).fraction, 0) << "nothing is counted";
}

// A table that covers only 380-780 nm leaves a negligible part of a colour unknown.
TEST(Coverage, ObserversSeeLittleBeyondTheRangeThatTablesMustCover) {
  constexpr NeededRange kNeeded;
  for (const Observer observer : {Observer::cie1931, Observer::cie1964}) {
    const ColorMatching& matching = color_matching(observer);
    for (const Curve* curve : {&matching.x, &matching.y, &matching.z})
      for (const Curve& light : {Curve(1.0), planck(2000), planck(20000)})
        EXPECT_LT(fraction_outside(*curve, light, kNeeded.low_nm, kNeeded.high_nm).fraction,
                  kNegligibleFraction);
  }
}

TEST(Coverage, TheMainRangeLeavesAThousandthAtEitherEnd) {
  const auto range = [](const Curve& curve) {
    const NeededRange found = main_range(curve);
    return std::pair(found.low_nm, found.high_nm);
  };
  EXPECT_EQ(range(Curve(-1.0)), std::pair(300.0, 1100.0));
  EXPECT_EQ(range(band(400.5, 699.5)), std::pair(400.0, 700.0));
  const auto with_tail = [](double value) { return sum(band(400, 700), band(700, 1100, value)); };
  EXPECT_EQ(range(with_tail(5e-4)), std::pair(400.0, 700.0)) << "0.2 nm in 300.2";
  EXPECT_EQ(range(with_tail(1e-3)), std::pair(400.0, 1100.0)) << "0.4 nm in 300.4";
  const auto [low, high] = main_range(Curve());
  EXPECT_GT(low, high) << "nothing is needed";
}

TEST(Coverage, ATableGoesOnAsItEnds) {
  constexpr std::array kNm{400.0, 700.0};
  constexpr std::array kValues{1.0, 3.0};
  for (const Outside outside : {Outside::zero, Outside::clamp, Outside::error}) {
    const NamedCurve table{"t", "", "", 400, 700, table_curve(kNm, kValues, outside), outside};
    const Curve held = extrapolated(table);
    EXPECT_EQ(held(300), 1);
    EXPECT_EQ(held(400), 1);
    EXPECT_EQ(held(550), 2);
    EXPECT_EQ(held(700), 3);
    EXPECT_EQ(held(1100), 3);
  }
}

}  // namespace
}  // namespace abbe

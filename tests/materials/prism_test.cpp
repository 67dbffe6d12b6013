#include "materials/interface/prism.h"

#include <cmath>

#include <gtest/gtest.h>

namespace abbe {
namespace {

constexpr double kNbk7 = 1.5168000345005885;  // N-BK7 at 587.5618 nm

TEST(Prism, TwoRefractionsMeetTheClosedFormAtTheMinimum) {
  for (const double n : {1.3, kNbk7, 1.9}) {
    for (const double apex : {10.0, 45.0, 60.0}) {
      const auto least = prism_minimum(n, apex);
      ASSERT_TRUE(least);
      const auto same = prism_passage(n, apex, least->incidence_deg);
      ASSERT_TRUE(same);
      EXPECT_NEAR(same->deviation_deg, least->deviation_deg, 1e-9);
      EXPECT_NEAR(same->Ts, least->Ts, 1e-12);
      EXPECT_NEAR(same->Tp, least->Tp, 1e-12);
      for (const double off : {-3.0, 3.0}) {
        const auto other = prism_passage(n, apex, least->incidence_deg + off);
        if (other) {
          EXPECT_GT(other->deviation_deg, least->deviation_deg);
        }
      }
    }
  }
}

TEST(Prism, ThinPrismsDeviateByNMinusOneTimesTheApex) {
  const auto passage = prism_passage(1.5, 0.01, 0);
  ASSERT_TRUE(passage);
  EXPECT_NEAR(passage->deviation_deg, 0.005, 1e-9);
}

TEST(Prism, TotalReflectionLetsNothingThrough) {
  EXPECT_FALSE(prism_minimum(2.1, 60));
  EXPECT_FALSE(prism_passage(kNbk7, 60, 29.188));
  EXPECT_TRUE(prism_passage(kNbk7, 60, 29.189));
}

}  // namespace
}  // namespace abbe

#include "sensor/film/patch.h"

#include <gtest/gtest.h>

#include <vector>

namespace abbe {
namespace {

TEST(GroupedMedian, OfUnequalValuesIsTheirMedian) {
  EXPECT_EQ(grouped_median({3}), 3);
  EXPECT_EQ(grouped_median({4, 1}), 2.5);
  EXPECT_EQ(grouped_median({9, 1, 2}), 2);
  EXPECT_EQ(grouped_median({9, 1, 2, 5}), 3.5);
}

TEST(GroupedMedian, OfCodesIsFinerThanTheirSteps) {
  EXPECT_EQ(grouped_median({7, 7, 7}), 7);
  EXPECT_NEAR(grouped_median({4, 5, 5, 5, 6, 6}), 5 + 1.0 / 6, 1e-12) << "two of the three from 4.5 to 5.5";
  EXPECT_NEAR(grouped_median({5, 5, 5, 6}), 5 + 1.0 / 6, 1e-12);
  EXPECT_NEAR(grouped_median({4, 5, 5, 5}), 5 - 1.0 / 6, 1e-12);
  EXPECT_NEAR(grouped_median({2, 2, 5, 5, 5, 6}), 4.5, 1e-12) << "one of the three from 3.5 to 5.5";
}

// Of 400 pixels, 4 may be defective at either end. These do not determine the width of a code.
TEST(GroupedMedian, FewValuesApartAreNoEndOfAStep) {
  const auto of = [](std::vector<double> values, std::size_t count, double value) {
    values.resize(values.size() + count, value);
    return values;
  };
  EXPECT_EQ(grouped_median(of(of({}, 396, 10), 4, 255)), 10);
  EXPECT_EQ(grouped_median(of({0, 57, 198, 255}, 396, 10)), 10);
  EXPECT_NEAR(grouped_median(of(of(of({}, 3, 9), 393, 10), 4, 57)), 10, 1e-12);
  const double share = 2 * 104.0 / 300 - 1;
  EXPECT_NEAR(grouped_median(of(of(of({}, 96, 9), 300, 10), 4, 57)), 10 + share / 2, 1e-12);
  EXPECT_NEAR(grouped_median(of(of(of({}, 300, 10), 50, 11), 4, 7)), 10 + 46.0 / 600, 1e-12)
      << "4 of 354 are no defects";
}

}  // namespace
}  // namespace abbe

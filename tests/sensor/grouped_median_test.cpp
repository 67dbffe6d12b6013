#include "sensor/film/grouped_median.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace abbe

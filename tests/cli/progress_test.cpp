#include "cli/progress.h"

#include <limits>

#include <gtest/gtest.h>

namespace abbe::cli {
namespace {

TEST(Progress, SaysShareRateErrorAndTimeLeft) {
  EXPECT_EQ(progress_line({0.25, 16, 4, 0.012}, false),
            " 25 %  16 samples/pixel  4/s  error 1.2 %  12 s left");
}

TEST(Progress, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(progress_line({1, 16, 4, std::numeric_limits<double>::infinity()}, false),
            "100 %  16 samples/pixel  4/s");
  EXPECT_EQ(error_text(0, ", relative "), "");
  EXPECT_EQ(error_text(0.012, ", relative "), ", relative error 1.2 %");
}

TEST(Progress, DrawsABarOfFixedWidth) {
  const std::string half = progress_line({0.5, 1, 0, 0}, true);
  EXPECT_TRUE(half.starts_with("[===============               ] ")) << half;
}

TEST(Progress, LongTimesAreInHoursAndMinutes) {
  EXPECT_TRUE(progress_line({0.5, 1, 7500, 0}, false).ends_with("2 h 05 min left"));
  EXPECT_TRUE(progress_line({0.5, 1, 61, 0}, false).ends_with("1 min 01 s left"));
}

}  // namespace
}  // namespace abbe::cli

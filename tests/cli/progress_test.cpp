#include "cli/progress.h"

#include <limits>

#include <gtest/gtest.h>

namespace abbe::cli {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

TEST(Progress, SaysShareRateErrorAndTimeLeft) {
  EXPECT_EQ(progress_line({0.25, 16, 4, 5, 12, {0.012, 0.05, 0.0004}, 16}, false),
            " 25 %  16 samples/pixel  4/s  error 1.2 % median, 5 % p95, 0.04 % of the mean  12 s left");
}

TEST(Progress, SaysOfHowManySamplesTheErrorIs) {
  EXPECT_EQ(progress_line({0.25, 16, 4, 5, 12, {.median = 0.012}, 8}, false),
            " 25 %  16 samples/pixel  4/s  error 1.2 % median at 8  12 s left");
}

TEST(Progress, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(progress_line({1, 16, 4, 4, 0, {}, 0}, false), "100 %  16 samples/pixel  4/s");
  EXPECT_EQ(progress_line({0.25, 16, 0, 4, kUnknown, {}, 0}, false), " 25 %  16 samples/pixel");
  EXPECT_EQ(error_text({}, ", "), "");
  EXPECT_EQ(error_text({.frame_mean = 0.012}, ", "), ", error 1.2 % of the mean");
}

TEST(Progress, DrawsABarOfFixedWidth) {
  const std::string half = progress_line({0.5, 1, 0, 0, kUnknown, {}, 0}, true);
  EXPECT_TRUE(half.starts_with("[===============               ] ")) << half;
}

TEST(Progress, LongTimesAreInHoursAndMinutes) {
  EXPECT_TRUE(progress_line({0.5, 1, 1, 7500, 7500, {}, 0}, false).ends_with("2 h 05 min left"));
  EXPECT_TRUE(progress_line({0.5, 1, 1, 61, 61, {}, 0}, false).ends_with("1 min 01 s left"));
}

}  // namespace
}  // namespace abbe::cli

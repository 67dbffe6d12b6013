#include "cli/progress.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace abbe::cli {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

TEST(Progress, SaysShareRateErrorAndTimeLeft) {
  EXPECT_EQ(progress_line({0.25, 16, 4, 5, 12, {0.028, 0.43, 0.0004}, 16}),
            " 25 %  16 spp  4/s  noise 2.8 % per pixel (43 % in the worst 5 %)  12 s left");
}

TEST(Progress, SaysThatFewSamplesLeaveTheErrorUnknown) {
  const Progress few{0.25, 16, 4, 5, 12, {.median = 0.028, .few_samples = 3}, 16};
  EXPECT_EQ(progress_line(few),
            " 25 %  16 spp  4/s  error not yet known: 3 samples carry half of the noise; increase --spp  12 "
            "s left");
  EXPECT_EQ(progress_line(few, 60), "[==         ]  25 %  16 spp  error not yet known  12 s left");
  EXPECT_EQ(error_text({.frame_mean = 0.012, .few_samples = 1}, ", "),
            ", error not yet known: 1 sample carries half of the noise; increase --spp");
  EXPECT_EQ(error_text({.frame_mean = 0.012, .hidden_noise = 40}, ", "),
            ", error not yet known: a pilot has 40 times this noise; increase --spp");
}

// Progress lines with all parts, on narrow and wide terminals.
TEST(Progress, FitsTheTerminalAndShowsTheTimeLeft) {
  const Progress full{0.25, 4096, 1234.5, 5, 7500, {0.028, 0.43, 0.0004}, 2048};
  std::size_t longest = 0;
  for (int columns = 20; columns <= 200; ++columns) {
    const std::string line = progress_line(full, columns);
    EXPECT_LT(line.size(), static_cast<std::size_t>(columns)) << line;
    EXPECT_TRUE(line.ends_with("2 h 05 min left")) << line;
    if (columns >= 32) {
      EXPECT_NE(line.find(" 25 %"), std::string::npos) << line;
    }
    if (columns >= 80) {
      EXPECT_NE(line.find("noise 2.8 % per pixel (43 % in the worst 5 %)"), std::string::npos) << line;
    }
    longest = std::max(longest, line.size());
  }
  EXPECT_EQ(longest, progress_line(full).size() + 33) << "with the whole bar";
}

TEST(Progress, SaysOfHowManySamplesTheErrorIs) {
  EXPECT_EQ(progress_line({0.25, 16, 4, 5, 12, {.median = 0.012}, 8}),
            " 25 %  16 spp  4/s  noise 1.2 % per pixel at 8 spp  12 s left");
}

TEST(Progress, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(progress_line({1, 16, 4, 4, 0, {}, 0}), "100 %  16 spp  4/s");
  EXPECT_EQ(progress_line({0.25, 16, 0, 4, kUnknown, {}, 0}), " 25 %  16 spp");
  EXPECT_EQ(error_text({}, ", "), "");
  EXPECT_EQ(error_text({.frame_mean = 0.012}, ", "), ", error 1.2 % of the mean");
  EXPECT_EQ(error_text({.median = 0.012, .frame_mean = 2.5}, ""),
            "noise 1.2 % per pixel, error 250 % of the mean");
}

TEST(Progress, DrawsABarOfFixedWidth) {
  const std::string half = progress_line({0.5, 1, 0, 0, kUnknown, {}, 0}, 80);
  EXPECT_TRUE(half.starts_with("[===============               ] ")) << half;
}

TEST(Progress, LongTimesAreInHoursAndMinutes) {
  EXPECT_TRUE(progress_line({0.5, 1, 1, 7500, 7500, {}, 0}).ends_with("2 h 05 min left"));
  EXPECT_TRUE(progress_line({0.5, 1, 1, 61, 61, {}, 0}).ends_with("1 min 01 s left"));
}

}  // namespace
}  // namespace abbe::cli

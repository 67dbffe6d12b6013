#include <gtest/gtest.h>

#include "tests/tier.h"

namespace abbe {
namespace {

// The night's alone: its tests would pass as those of the day if they were not told.
TEST(NightlyTier, IsToldToItsTests) {
  EXPECT_TRUE(test::nightly());
}

}  // namespace
}  // namespace abbe

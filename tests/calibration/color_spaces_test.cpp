#include "calibration/output/color_spaces.h"

#include <gtest/gtest.h>

#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

TEST(ColorSpaces, NothingAdaptsToAWhiteWithoutConeResponse) {
  EXPECT_FALSE(bradford({0, 0, 0}, unit_xyz(kD65)));
}

}  // namespace
}  // namespace abbe

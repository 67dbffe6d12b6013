#include "calibration/output/color_spaces.h"

#include <gtest/gtest.h>

#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

void expect_reference(const Matrix3& m, const std::string& name) {
  static const test::ReferenceTable table("colour_matrices");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!table.text(row, "name").starts_with(name)) continue;
    test::expect_matrix(m, table, row, 1e-9);
    return;
  }
  ADD_FAILURE() << "no reference " << name;
}

TEST(ColorSpaces, MatricesOfRgbSpaces) {
  expect_reference(rgb_to_xyz(kRec709), "RGB_to_XYZ sRGB");
  expect_reference(rgb_to_xyz(kRec709).inverse(), "XYZ_to_RGB sRGB");
  expect_reference(rgb_to_xyz(kAces2065), "RGB_to_XYZ ACES2065-1");
}

TEST(ColorSpaces, BradfordAdaptation) {
  const XYZ a = unit_xyz({0.44758, 0.40745});
  const XYZ d50 = unit_xyz({0.3457, 0.3585});
  const XYZ d65 = unit_xyz(kD65);
  expect_reference(bradford(a, d65).value(), "Bradford adaptation A to D65");
  expect_reference(bradford(d50, d65).value(), "Bradford adaptation D50 to D65");
  expect_reference(bradford(d65, d50).value(), "Bradford adaptation D65 to D50");
}

TEST(ColorSpaces, NothingAdaptsToAWhiteWithoutConeResponse) {
  EXPECT_FALSE(bradford({0, 0, 0}, unit_xyz(kD65)));
}

}  // namespace
}  // namespace abbe

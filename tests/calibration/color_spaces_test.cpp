#include "calibration/output/color_spaces.h"

#include <gtest/gtest.h>

#include "spectral/rgb.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

TEST(ColorSpaces, EveryAdaptationTakesWhiteToWhite) {
  const XYZ a = unit_xyz({0.44758, 0.40745});
  const XYZ d65 = unit_xyz(kD65);
  const Matrix3 bradford = adaptation(a, d65).value();
  for (const Adaptation method : {Adaptation::bradford, Adaptation::cat02, Adaptation::cat16}) {
    const Matrix3 m = adaptation(a, d65, method).value();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(multiply(m, a)[i], d65[i], 1e-12);
    EXPECT_TRUE((adaptation(d65, a, method).value() * m).equalWithAbsError(Matrix3(), 1e-12));
    EXPECT_EQ(m.equalWithAbsError(bradford, 1e-3), method == Adaptation::bradford);
  }
}

// Expected values computed independently from the published matrix [Li2017].
TEST(ColorSpaces, Cat16FromAToD65) {
  const Matrix3 expected(0.9506814642, -0.1874060997, 0.2629224878, -0.0256698866, 1.0323135659,
                         -0.0115667695, -0.0027424281, 0.0910143911, 2.8135491680);
  const auto m = adaptation(unit_xyz({0.44758, 0.40745}), unit_xyz(kD65), Adaptation::cat16);
  EXPECT_TRUE(m.value().equalWithAbsError(expected, 1e-9));
}

TEST(ColorSpaces, NothingAdaptsToAWhiteWithoutConeResponse) {
  EXPECT_FALSE(adaptation({0, 0, 0}, unit_xyz(kD65)));
}

}  // namespace
}  // namespace abbe

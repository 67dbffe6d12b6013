#include "calibration/chart/patches.h"

#include <gtest/gtest.h>

#include <map>

#include "spectral/sources.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

TEST(Patches, OneChannelIsItsOwnReference) {
  const std::vector<Channel> ccd = test::camera("kodak_kaf-3200me");
  ASSERT_EQ(ccd.size(), 1U);
  EXPECT_NEAR(camera_raw(ccd, test::illuminant("A"), Curve(0.25))[0], 0.25, 1e-12);
}

TEST(Patches, ACameraCountsWhatEyesDoNotSee) {
  std::vector<Channel> camera = test::camera();
  camera[0].weight = band(590, 1000);
  EXPECT_NEAR(diffuser_values(camera, planck(3000))[0], integral_of_product(camera[0].weight, planck(3000)),
              2e-3 * integral_of_product(camera[0].weight, planck(3000)));
}

TEST(Patches, RefusesWhatCannotBeCalibrated) {
  const Curve light = test::illuminant("D65");
  test::expect_error(
      [&] { static_cast<void>(integrate(test::chart(), test::camera("kodak_kaf-3200me"), light)); },
      ErrorCode::usage, "three channels (got 1)");
  std::vector<Channel> blind = test::camera();
  blind[2].weight = Curve();
  test::expect_error([&] { static_cast<void>(integrate(test::chart(), blind, light)); }, ErrorCode::input,
                     "channel B: the light gives it nothing");
}

}  // namespace
}  // namespace abbe

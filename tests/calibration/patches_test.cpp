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

// Stacked filters with edges of one nanometre: the sensor integrates their area.
TEST(Patches, LineFiltersCountTheirArea) {
  std::vector<Channel> camera = test::camera();
  const Curve triangle({{545, 0}, {546, 1}, {547, 0}});
  camera[1].weight = product(triangle, triangle);
  EXPECT_NEAR(diffuser_values(camera, Curve(1))[1], 2.0 / 3, 1e-12);
  EXPECT_NEAR(diffuser_values(camera, triangle)[1], 1.0 / 2, 1e-4);
}

// A light with teeth of 0.9 nm between whole nanometres.
TEST(Patches, TheBalanceUnderSharpTeethIsThatOfTheirLight) {
  std::vector<Knot> teeth;
  for (const double nm : {410, 540, 612})
    teeth.insert(teeth.end(), {{nm + 0.05, 0}, {nm + 0.95, 5}, {nm + 0.96, 0}});
  const Curve lamp(teeth);
  const std::vector<Channel> camera = test::camera();
  for (const Channel& channel : camera) {
    double seen = 0;
    constexpr int kParts = 1000;
    for (int i = 0; i < 400 * kParts; ++i) {
      const double nm = 380 + (i + 0.5) / kParts;
      seen += lamp(nm) * channel.weight(nm) / kParts;
    }
    EXPECT_NEAR(diffuser_values({&channel, 1}, lamp)[0] / seen, 1, 1e-5) << channel.name;
  }
}

TEST(Patches, RefusesWhatCannotBeCalibrated) {
  const Curve light = test::illuminant("D65");
  test::expect_error(
      [&] { static_cast<void>(integrate(test::chart(), test::camera("kodak_kaf-3200me"), light)); },
      ErrorCode::usage, "three channels (got 1)");
  std::vector<Channel> blind = test::camera();
  blind[2].weight = Curve();
  test::expect_error([&] { static_cast<void>(integrate(test::chart(), blind, light)); }, ErrorCode::input,
                     "channel B: it receives nothing from the light");
}

}  // namespace
}  // namespace abbe

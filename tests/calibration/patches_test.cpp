#include "calibration/chart/patches.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

Curve patch_of(const std::string& spectra, const std::string& index) {
  if (index == "0") return Curve(1.0);
  return test::chart(spectra).patches.at(std::stoul(index) - 1).reflectance;
}

TEST(Patches, RawValuesOfAMeasuredCamera) {
  const test::ReferenceTable table("camera_raw_colorchecker");
  ASSERT_EQ(table.rows(), 100U);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::vector<Channel> camera = test::camera(table.text(row, "camera"));
    const Curve light = test::illuminant(table.text(row, "illuminant"));
    const std::vector<double> raw =
        camera_raw(camera, light, patch_of(table.text(row, "spectra"), table.text(row, "index")));
    ASSERT_EQ(raw.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(raw[k], table.number(row, "raw_" + camera[k].name), 5.1e-8) << table.text(row, "patch");
  }
}

TEST(Patches, ColoursOfTheChart) {
  const test::ReferenceTable table("colorchecker_babelcolor_2deg");
  std::map<std::string, PatchColors> integrated;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string light = table.text(row, "illuminant");
    if (!integrated.contains(light))
      integrated[light] = integrate(test::chart(), test::camera(), test::illuminant(light));
    const PatchColors& colors = integrated[light];
    const auto i = static_cast<std::size_t>(table.number(row, "index")) - 1;
    EXPECT_EQ(colors.names.at(i), table.text(row, "patch"));
    const char* names[] = {"X", "Y", "Z"};
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(100 * colors.xyz.at(i)[k], table.number(row, names[k]), 1e-6);
  }
  for (const auto& [light, colors] : integrated) EXPECT_NEAR(colors.white[1], 1, 1e-12) << light;
}

TEST(Patches, OneChannelIsItsOwnReference) {
  const std::vector<Channel> ccd = test::camera("kodak_kaf-3200me");
  ASSERT_EQ(ccd.size(), 1U);
  EXPECT_NEAR(camera_raw(ccd, test::illuminant("A"), Curve(0.25))[0], 0.25, 1e-12);
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

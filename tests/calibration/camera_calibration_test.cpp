#include "calibration/camera_calibration.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "io/json.h"
#include "io/text.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

CalibrationSetup setup(const std::string& response, int bits = 12) {
  return {"Nikon_D5100", "D65", response, bits, test::camera(), test::illuminant("D65"), test::chart()};
}

std::optional<JsonValue> parse(const std::string& text) {
  Diagnostics diagnostics;
  auto value = parse_json(std::make_shared<const SourceText>(SourceText{"report", text}), diagnostics);
  EXPECT_TRUE(value.has_value()) << diagnostics.text() << text;
  return value;
}

TEST(CameraCalibration, RecoversCurveAndColour) {
  const MatrixFit ideal = fit_matrix(integrate(test::chart(), test::camera(), test::illuminant("D65")));
  for (const char* response : {"linear", "gamma:2.2", "s-curve"}) {
    const CameraCalibration calibration = calibrate_camera(setup(response));
    for (const ChannelResponse& r : calibration.responses)
      EXPECT_LT(r.max_error, 0.003) << response << r.channel;
    EXPECT_LE(calibration.matrix.errors.mean, calibration.matrix.start.mean) << response;
    EXPECT_NEAR(calibration.matrix.errors.mean, ideal.errors.mean, 0.03) << response;
    EXPECT_NEAR(calibration.matrix.errors.max, ideal.errors.max, 0.1) << response;
  }
}

TEST(CameraCalibration, CoarserCodesCostColour) {
  const double fine = calibrate_camera(setup("linear", 12)).matrix.errors.mean;
  EXPECT_GT(calibrate_camera(setup("linear", 7)).matrix.errors.mean, fine + 0.05);
}

TEST(CameraCalibration, WritesConfigAndReport) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("abbe_calibration_test_" + std::to_string(::getpid()));
  CalibrationSetup named = setup("gamma:2.2");
  named.camera = "a \"quoted\\ name";
  const CameraCalibration calibration = calibrate_camera(named);
  write_calibration(folder, named, calibration);
  for (const char* name : {"config.ocio", "camera.spi1d", "camera.clf"})
    EXPECT_GT(std::filesystem::file_size(folder / name), 1000U) << name;
  Diagnostics diagnostics;
  const auto text = read_text(folder / "report.json", diagnostics);
  ASSERT_TRUE(text) << diagnostics.text();
  const auto report = parse(text->text);
  ASSERT_TRUE(report);
  EXPECT_EQ(std::get<std::string>(report->find("camera")->value), named.camera);
  EXPECT_EQ(std::get<double>(report->find("dE00_mean")->value), calibration.matrix.errors.mean);
  EXPECT_EQ(std::get<JsonValue::Array>(report->find("patches")->value).size(), 24U);
  EXPECT_EQ(std::get<JsonValue::Array>(report->find("responses")->value).size(), 3U);
  std::filesystem::remove_all(folder);
}

TEST(CameraCalibration, RefusesBadSetups) {
  test::expect_error([] { static_cast<void>(calibrate_camera(setup("linear", 17))); }, ErrorCode::usage,
                     "bits: expected 0 to 16 (got 17)");
  CalibrationSetup one = setup("linear");
  one.channels.resize(1);
  test::expect_error([&] { static_cast<void>(calibrate_camera(one)); }, ErrorCode::usage,
                     "three channels (got 1 of");
}

}  // namespace
}  // namespace abbe

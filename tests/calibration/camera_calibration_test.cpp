#include "calibration/camera_calibration.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "io/text.h"
#include "spectral/sources.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

CalibrationSetup setup(const std::string& response, int bits = 12) {
  return {"Nikon_D5100", "D65", response, bits, test::camera(), test::illuminant("D65"), test::chart()};
}

// Options with a minimal validation of the fit, which takes most of the time.
CharacterisationOptions hardly_judged() {
  CharacterisationOptions options;
  options.folds = 2;
  options.bootstrap_draws = 2;
  return options;
}

TEST(CameraCalibration, RecoversCurveAndColour) {
  const CorrectionFit ideal =
      fit_correction(integrate(test::chart(), test::camera(), test::illuminant("D65")));
  for (const char* response : {"linear", "gamma:2.2", "s-curve"}) {
    const CameraCalibration calibration = calibrate_camera(setup(response), hardly_judged());
    for (const ChannelResponse& r : calibration.responses)
      EXPECT_LT(r.max_error, 0.003) << response << r.channel;
    EXPECT_LE(calibration.correction.errors.mean, calibration.correction.start.mean) << response;
    EXPECT_NEAR(calibration.correction.errors.mean, ideal.errors.mean, 0.03) << response;
    EXPECT_NEAR(calibration.correction.errors.max, ideal.errors.max, 0.1) << response;
  }
}

// The columns of a camera's table are identified by name, in any order and spelling.
TEST(CameraCalibration, ColumnsOfACameraAreMappedByName) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / ("abbe_camera_" + std::to_string(::getpid()) + ".csv");
  for (const char* columns : {"b,g,r", "blue,green,red", "Blue,G,r", "B,G,R"}) {
    std::ofstream(path) << "# unit: relative sensitivity\n# outside: zero\nwavelength_nm," << columns
                        << "\n400,0,0,0\n450,1,0,0\n550,0,1,0\n650,0,0,1\n700,0,0,0\n";
    Diagnostics diagnostics;
    const auto channels = camera_channels(path.string(), {}, diagnostics);
    ASSERT_TRUE(channels) << diagnostics.text();
    std::string initials;
    for (const Channel& channel : *channels) initials += channel.name.front();
    EXPECT_EQ(lower_case(initials), "rgb") << columns;
    for (std::size_t k = 0; k < 3; ++k) {
      const double peak_nm = 650 - 100 * static_cast<double>(k);
      const std::vector<double> seen = camera_raw(*channels, Curve(1.0), band(peak_nm - 20, peak_nm + 20));
      EXPECT_EQ(std::max_element(seen.begin(), seen.end()) - seen.begin(), static_cast<std::ptrdiff_t>(k))
          << columns;
    }
  }
  std::filesystem::remove(path);
}

TEST(CameraCalibration, CoarserCodesCostColour) {
  const auto mean_of = [](int bits) {
    return calibrate_camera(setup("linear", bits), hardly_judged()).correction.errors.mean;
  };
  EXPECT_GT(mean_of(7), mean_of(12) + 0.05);
}

TEST(CameraCalibration, ProfileShowsWhatTheFitSays) {
  for (const Adaptation method : {Adaptation::bradford, Adaptation::cat16}) {
    CharacterisationOptions options = hardly_judged();
    options.adaptation = method;
    CalibrationSetup tungsten = setup("gamma:2.2");
    tungsten.illuminant = "A";
    tungsten.light = test::illuminant("A");
    const CameraCalibration calibration = calibrate_camera(tungsten, options);
    const CameraProfile& profile = calibration.profile;
    EXPECT_EQ(profile.light, "A");
    const std::vector<double> diffuser = diffuser_values(tungsten.channels, tungsten.light);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(profile.gains[k] / profile.gains[1] * diffuser[k] / diffuser[1], 1, 0.005);
    const Raw white{1 / profile.gains[0], 1 / profile.gains[1], 1 / profile.gains[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(to_xyz_d65(profile, white)[i], unit_xyz(kD65)[i], 1e-12);
      EXPECT_NEAR(multiply(matrix_to_xyz_d65(profile), white)[i], unit_xyz(kD65)[i], 1e-12);
    }
    const Matrix3 expected =
        adaptation(integrate(tungsten.chart, tungsten.channels, tungsten.light).white, unit_xyz(kD65), method)
            .value();
    EXPECT_EQ(profile.adaptation, expected);
  }
}

TEST(CameraCalibration, ProfileHasTheNamesOfTheChannels) {
  CalibrationSetup observer = setup("linear");
  observer.channels = observer_channels(Observer::cie1931);
  EXPECT_EQ(calibrate_camera(observer, hardly_judged()).profile.channels,
            (std::array<std::string, 3>{"X", "Y", "Z"}));
}

// One patch is brighter than the diffuser, as a fluorescent one may be; the profile records its measured
// value.
TEST(CameraCalibration, ProfileTellsTheBrightestPatch) {
  MeasuredCamera camera{"mine", "D65", {test::nikon("D65"), {1 / 2000.0, 1 / 3500.0, 1 / 3000.0}}, {}};
  camera.chart.colors.raw[4] = {0.5, 1.2, 0.9};
  CharacterisationOptions options = hardly_judged();
  options.fit.objective = Objective::xyz;
  EXPECT_NEAR(calibrate_measured(camera, options).profile.brightest_patch, 4200, 1e-9);
}

TEST(CameraCalibration, JudgesPatchesItHasNotSeen) {
  const CameraCalibration one_out = calibrate_camera(setup("linear"));
  CharacterisationOptions options = hardly_judged();
  options.folds = 4;
  const CameraCalibration folds = calibrate_camera(setup("linear"), options);
  EXPECT_GT(one_out.unseen.mean, one_out.correction.errors.mean);
  EXPECT_GT(folds.unseen.mean, one_out.unseen.mean);
  EXPECT_LT(one_out.unseen_mean.low, one_out.unseen.mean);
  EXPECT_GT(one_out.unseen_mean.high, one_out.unseen.mean);
  ASSERT_EQ(one_out.columns.size(), 3U);
  for (std::size_t t = 0; t < 3; ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT(one_out.columns[t][i].low, one_out.columns[t][i].high);
      EXPECT_NEAR(one_out.columns[t][i].low, one_out.profile.correction.columns[t][i], 0.3);
    }
}

TEST(CameraCalibration, RefusesBadSetups) {
  test::expect_error([] { static_cast<void>(calibrate_camera(setup("linear", 17))); }, ErrorCode::usage,
                     "--bits: expected 0 to 16 (got 17)");
  CalibrationSetup one = setup("linear");
  one.channels.resize(1);
  test::expect_error([&] { static_cast<void>(calibrate_camera(one)); }, ErrorCode::usage,
                     "three channels (got 1 of");
  CharacterisationOptions cubic;
  cubic.fit.model = CorrectionModel::root_polynomial_3;
  test::expect_error([&] { static_cast<void>(calibrate_camera(setup("linear"), cubic)); }, ErrorCode::usage,
                     "13 terms on 24 patches");
  CharacterisationOptions folds;
  folds.folds = 25;
  test::expect_error([&] { static_cast<void>(calibrate_camera(setup("linear"), folds)); }, ErrorCode::usage,
                     "--folds: got 25, allowed 2 to the 24 patches");
}

}  // namespace
}  // namespace abbe

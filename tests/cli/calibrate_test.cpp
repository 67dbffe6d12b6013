#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "calibration/chart/patches.h"
#include "cli/calibrate.h"
#include "io/data_directory.h"
#include "io/text.h"
#include "spectral/chart.h"
#include "spectral/library.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"

namespace abbe::test {
namespace {

using namespace abbe::cli;

CalibrateOptions nikon() {
  CalibrateOptions options;
  options.camera = "Nikon_D5100";
  options.how.bootstrap_draws = 2;
  return options;
}

TEST(Calibrate, TakesValuesForLinearUnlessAskedToRecoverThem) {
  const json plain = json_output(calibrate, nikon());
  EXPECT_TRUE(plain["responses"].empty());
  EXPECT_FALSE(plain.contains("planted_response"));
  EXPECT_EQ(plain["bits"], 12);
  EXPECT_EQ(plain["correction"]["model"], "matrix");
  EXPECT_EQ(plain["white_values"].size(), 3U);
  CalibrateOptions asked = nikon();
  asked.planted_response = "gamma:2.2";
  EXPECT_EQ(json_output(calibrate, asked)["responses"].size(), 3U);
}

// The page also shows measurements of the sensor by other commands.
TEST(Calibrate, ShowsNoiseAndSharpnessOnItsPage) {
  CalibrateOptions options = nikon();
  options.output = scratch() / "measured";
  options.transfer = scratch() / "transfer.json";
  options.mtf = scratch() / "mtf.json";
  std::ofstream(options.transfer) << R"({"channel": ["R", "G"], "gain_e_per_dn": [0.348, 0.351],
    "dynamic_range_db": [66.25, null], "signal_dn": [[10, 100], [12, 120]], "variance_dn2": [[30, 290], [35, 340]]})";
  std::ofstream(options.mtf) << R"({"mtf50": 0.3125, "frequency": [0, 0.25, 0.5], "mtf": [1, 0.6, 0.2]})";
  json_output(calibrate, options);
  const std::string page = read_file(options.output / "report.html");
  for (const char* text : {"<td>0.348</td><td>0.351</td>", "<td>66.25</td><td>–</td>", "Photon transfer",
                           "one half at 0.3125 cycles", "Modulation transfer"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(page.find("signal_dn</td>"), std::string::npos);
  for (const char* damaged : {R"({"channel": ["R"], "signal_dn": [[1]]})", R"({"mtf": 1})", "[", "3"}) {
    std::ofstream(options.transfer) << damaged;
    EXPECT_EQ(fault([&] { calibrate(options); }, "is not an answer that the command printed with --json"),
              ErrorCode::input);
  }
  options.output.clear();
  EXPECT_EQ(fault([&] { calibrate(options); }, "which needs --output"), ErrorCode::usage);
}

TEST(Calibrate, WritesTheMatricesOfDngAndTheCurvesOfRawtoaces) {
  CalibrateOptions options = nikon();
  options.illuminants = "A,FL11,D65";
  options.output = scratch() / "nikon";
  json_output(calibrate, options);
  const json dng = json::parse(read_file(options.output / "dng.json"));
  ASSERT_EQ(dng["lights"].size(), 2U);
  EXPECT_EQ(dng["lights"][0]["CalibrationIlluminant"], 17);
  EXPECT_EQ(dng["lights"][1]["CalibrationIlluminant"], 21);
  ASSERT_EQ(dng["between"].size(), 1U);
  EXPECT_EQ(dng["between"][0]["light"], "FL11");
  EXPECT_GT(dng["between"][0]["dE00_mean"], dng["between"][0]["own_dE00_mean"]);
  EXPECT_LT(dng["between"][0]["dE00_mean"], 2);
  const std::string page = read_file(options.output / "report.html");
  for (const char* text :
       {"Nikon_D5100 under FL11", "Vora value 0.931", "dark skin", "Patches left out of the fit"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(page.find("<?xml"), std::string::npos);
  // The written spectral responses can be used like those of any camera.
  CalibrateOptions again = nikon();
  again.camera = (options.output / "sensitivities.json").string();
  const double first = json_output(calibrate, nikon())["dE00_mean"];
  EXPECT_NEAR(json_output(calibrate, again)["dE00_mean"].get<double>(), first, 0.01);
}

// OpenColorIO rejects a CLF with bytes that are not UTF-8, and pages declare UTF-8.
TEST(Calibrate, NamesThatAreNoUtf8StandInNoFileAsTheyAre) {
  CalibrateOptions options = nikon();
  options.camera = (scratch() / "caf\xE9.csv").string();
  std::filesystem::copy_file(data_directory() / "camera/Nikon_D5100.csv", options.camera);
  const std::filesystem::path light = scratch() / "li\xE9ght.csv";
  std::ofstream(light) << "# unit: relative\nwavelength_nm,value\n380,1\n780,2\n";
  options.illuminants = "A," + light.string();
  options.output = scratch() / "folder";
  json_output(calibrate, options);
  for (const char* name : {"camera_A.clf", "camera_A_to_aces.clf", "config.ocio", "report.html"}) {
    const std::string text = read_file(options.output / name);
    EXPECT_NE(text.find("caf\uFFFD.csv under A"), std::string::npos) << name;
    EXPECT_EQ(valid_prefix(text), text.size()) << name;
  }
}

// Cells "R,G,B" of the values that the Nikon gives for a reflectance, times `white`.
std::string nikon_cells(const std::string& light, double white, const Curve& reflectance) {
  Diagnostics diagnostics;
  const auto channels = load_camera("Nikon_D5100", {}, diagnostics);
  const auto raw = camera_raw(*channels, load_illuminant(light, {}, diagnostics)->curve, reflectance);
  return fmt::format("{},{},{}", white * raw[0], white * raw[1], white * raw[2]);
}

// Table of the camera values of the chart, in the format of `abbe measure`.
std::string measured_table(const std::string& light, double white, const std::string& saturated = "") {
  std::string rows =
      "# unit: linear camera "
      "values\npatch,R,G,B,R_deviation,G_deviation,B_deviation,R_pixels,G_pixels,B_pixels,R_saturated,G_"
      "saturated,B_saturated\n";
  for (const Patch& patch : shipped_chart("colorchecker24_babelcolor_average").patches)
    rows += fmt::format("{},{},0.001,0.001,0.001,100,100,100,0,{},0\n", patch.name,
                        nikon_cells(light, white, patch.reflectance), patch.name == saturated ? 0.1 : 0);
  return rows;
}

TEST(Calibrate, TrainsAPhotographedCameraOnSpectraSeenThroughItsCurves) {
  CalibrateOptions options = nikon();
  options.measured = scratch() / "patches.csv";
  std::ofstream(options.measured) << measured_table("D65", 300);
  EXPECT_EQ(fault([&] { calibrate(options); }, "--camera with --measured only for --training"),
            ErrorCode::usage);
  options.training = "cie224_ces01-99_5nm,pmc_chart_luo2024";
  const json trained = json_output(calibrate, options);
  EXPECT_EQ(trained["training_patches"], 99 + 30);
  EXPECT_LT(trained["dE00_mean"], 2);
  options.camera.clear();
  EXPECT_EQ(fault([&] { calibrate(options); }, "needs --camera"), ErrorCode::usage);
  options.camera = "Nikon_D5100";
  options.training = options.chart;
  EXPECT_EQ(fault([&] { calibrate(options); }, "the chart itself"), ErrorCode::usage);
}

// Values of a chart and the perfect diffuser in D65, without noise.
std::string noiseless_table(const std::string& chart) {
  std::string rows = "# unit: linear camera values\npatch,R,G,B\n";
  for (const Patch& patch : shipped_chart(chart).patches)
    rows += fmt::format("{},{}\n", patch.name, nikon_cells("D65", 300, patch.reflectance));
  return rows + fmt::format("perfect diffuser,{}\n", nikon_cells("D65", 300, Curve(1.0)));
}

TEST(Calibrate, TestsAMeasuredCameraOnAnotherChartAsASimulatedOne) {
  CalibrateOptions options = nikon();
  options.bits = 0;
  options.test = "pmc_chart_luo2024";
  const json simulated = json_output(calibrate, options);
  options.camera.clear();
  options.measured = scratch().write("one.csv", noiseless_table("colorchecker24_babelcolor_average"));
  options.test_measured = scratch().write("other.csv", noiseless_table("pmc_chart_luo2024"));
  const json measured = json_output(calibrate, options);
  for (const char* key : {"dE00_mean", "test_dE00_mean", "test_dE00_max"})
    EXPECT_NEAR(measured[key], simulated[key], 1e-4) << key;
  EXPECT_GT(measured["test_dE00_mean"], 0.1);
  options.test = options.chart;
  EXPECT_EQ(fault([&] { calibrate(options); }, "unknown patch"), ErrorCode::input);
  const std::string alone = "calibrate --measured " + options.measured.string() + " --test pmc_chart_luo2024";
  EXPECT_NE(abbe(alone).err.find("--test-measured"), std::string::npos);
}

// Spectral responses of the Nikon as a table with these columns.
std::string camera_table(const std::vector<std::size_t>& order) {
  Diagnostics diagnostics;
  const auto channels = load_camera("Nikon_D5100", {}, diagnostics);
  std::string rows = "# unit: relative\n# outside: zero\nwavelength_nm";
  for (const std::size_t k : order) rows += "," + (*channels)[k].name;
  for (int nm = 400; nm <= 700; nm += 10) {
    rows += fmt::format("\n{}", nm);
    for (const std::size_t k : order) rows += fmt::format(",{}", (*channels)[k].weight(nm));
  }
  return rows + "\n";
}

TEST(Calibrate, TakesCurvesForWhatTheyAreSaidToMultiply) {
  const std::string table = camera_table({0, 1, 2});
  CalibrateOptions options = nikon();
  options.camera = scratch().write("energy.csv", table).string();
  const double energy = json_output(calibrate, options)["dE00_mean"];
  options.camera_response = ResponseKind::quantum;
  const double quantum = json_output(calibrate, options)["dE00_mean"];
  EXPECT_GT(std::abs(quantum - energy), 0.01);
  options.camera = "box:400-500,500-600,600-700";
  EXPECT_EQ(fault([&] { calibrate(options); }, "applies to measured curves only (got box:400-500"),
            ErrorCode::usage);
  const Outcome alone = abbe("calibrate --all-cameras --camera-response quantum");
  EXPECT_EQ(alone.code, 2) << alone.err;
}

TEST(Calibrate, RefusesChartsInPercent) {
  CalibrateOptions options = nikon();
  options.chart = scratch()
                      .write("percent.csv",
                             "# unit: reflectance in percent\n# outside: clamp\n"
                             "wavelength_nm,a\n400,0.5\n700,0.9\n")
                      .string();
  EXPECT_EQ(fault([&] { calibrate(options); }, "allowed fractions of 1"), ErrorCode::input);
  std::swap(options.chart, options.training);
  options.chart = "colorchecker24_babelcolor_average";
  EXPECT_EQ(fault([&] { calibrate(options); }, "allowed fractions of 1"), ErrorCode::input);
}

TEST(Calibrate, KnowsRedGreenAndBlueByNameInWhateverOrderAFileHasThem) {
  const auto in_order = [](const std::string& name, const std::vector<std::size_t>& order) {
    CalibrateOptions options = nikon();
    options.camera = scratch().write(name, camera_table(order)).string();
    options.how.fit.objective = Objective::xyz;
    return options;
  };
  CalibrateOptions rgb = in_order("rgb.csv", {0, 1, 2});
  CalibrateOptions bgr = in_order("bgr.csv", {2, 1, 0});
  const json expected = json_output(calibrate, rgb);
  const json found = json_output(calibrate, bgr);
  for (const char* key : {"white_values", "to_xyz_d65", "dE00_mean"})
    EXPECT_EQ(found[key], expected[key]) << key;
  // Columns of a table and channels of a camera are matched by name.
  for (CalibrateOptions* options : {&rgb, &bgr}) {
    options->measured = scratch().write("measured_rgb.csv", measured_table("D65", 300));
    options->training = "pmc_chart_luo2024";
  }
  EXPECT_EQ(json_output(calibrate, bgr)["dE00_max"], json_output(calibrate, rgb)["dE00_max"]);
  bgr.camera = "observer:1931";
  EXPECT_EQ(
      fault([&] { calibrate(bgr); }, "--camera: has the channels X, Y, Z (allowed with --measured R, G"),
      ErrorCode::input);
}

// Measured colours in a table belong to its own illuminant, so that no other illuminant can be calibrated.
TEST(Calibrate, IsOfTheLightThatAChartTellsItsColoursIn) {
  CalibrateOptions options = nikon();
  options.camera.clear();
  options.chart = "colorchecker24_babelcolor_average_xyY";
  options.measured = scratch().write("measured_d50.csv", measured_table("D50", 300));
  for (const char* other : {"D65", "A"}) {
    options.illuminants = other;
    EXPECT_EQ(fault([&] { calibrate(options); }, fmt::format("--illuminant: got {} with the white (", other)),
              ErrorCode::usage);
    EXPECT_EQ(fault([&] { calibrate(options); }, "in a light with the white (0.3457, 0.3585)"),
              ErrorCode::usage);
  }
  options.illuminants = "D50";
  EXPECT_LT(json_output(calibrate, options)["dE00_mean"], 1.5);
}

TEST(Calibrate, AFolderHoldsOneCalibration) {
  CalibrateOptions options = nikon();
  options.output = scratch() / "held";
  options.illuminants = "D65,A";
  json_output(calibrate, options);
  EXPECT_EQ(json::parse(read_file(options.output / "dng.json"))["camera"], "Nikon_D5100");
  for (const char* mine : {"notes.clf", "camera_mine.cube"}) std::ofstream(options.output / mine) << "mine";
  options.camera = "Canon_EOS_5D";
  options.illuminants = "D65";
  json_output(calibrate, options);
  std::set<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(options.output))
    left.insert(entry.path().filename().string());
  EXPECT_EQ(left, (std::set<std::string>{"camera_D65.clf", "camera_D65_to_aces.clf", "camera_mine.cube",
                                         "config.ocio", "notes.clf", "report.html", "report.json",
                                         "sensitivities.json"}));
}

TEST(Calibrate, FaultsOfMeasuredValuesAreSentences) {
  CalibrateOptions options;
  options.how.bootstrap_draws = 2;
  options.measured = scratch() / "patches.csv";
  const auto with = [&](const std::string& text) {
    std::ofstream(options.measured) << text;
    return [options] { calibrate(options); };
  };
  // Equal patches reveal nothing about the camera.
  std::string grey = "# unit: linear camera values\npatch,R,G,B\n";
  Diagnostics diagnostics;
  const Chart chart = load_chart(options.chart, {}, diagnostics).value();
  for (const Patch& patch : chart.patches) grey += patch.name + ",0.5,0.5,0.5\n";
  EXPECT_EQ(fault(with(grey), "do not determine the correction: they show 0 independent colours (needed 2)"),
            ErrorCode::input);
  std::string negative = measured_table("D65", 1);
  const std::size_t at = negative.find("0.001,0.001,0.001");
  negative.replace(at, 5, "-0.01");
  EXPECT_EQ(fault(with(negative), "expected deviations of 0 or more"), ErrorCode::input);
  testing::internal::CaptureStderr();
  options.json = true;
  testing::internal::CaptureStdout();
  with(measured_table("D65", 1, "cyan"))();
  (void)testing::internal::GetCapturedStdout();
  EXPECT_NE(testing::internal::GetCapturedStderr().find("patch \"cyan\" has saturated pixels"),
            std::string::npos);
}

// Options for the colours of one camera do not apply to all cameras or to response curves alone.
TEST(Calibrate, OptionsOfColoursAreRefusedWhereThereAreNone) {
  const auto expect_refused = [](const std::string& what, const std::string& option) {
    const Outcome run = abbe("calibrate " + what + " " + option);
    EXPECT_EQ(run.code, 2) << what << ' ' << option;
    EXPECT_NE(run.err.find(option.substr(0, option.find(' '))), std::string::npos) << run.err;
  };
  for (const char* option : {"--correction auto", "--objective dE76", "--adaptation cat02", "--folds 3",
                             "--transfer t.json", "--mtf m.json", "--training pmc_chart_luo2024"})
    for (const char* what : {"--all-cameras", "--series x.json"}) expect_refused(what, option);
  expect_refused("--all-cameras", "--output folder");
  for (const char* option : {"--chart nonsense", "--illuminant nonsense"})
    expect_refused("--series x.json", option);
}

}  // namespace
}  // namespace abbe::test

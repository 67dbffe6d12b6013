#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "calibration/chart/measured_patches.h"
#include "cli/calibrate.h"
#include "develop/find_chart.h"
#include "io/picture.h"
#include "spectral/library.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"

// Calibrations from raw files, and from values that `abbe measure` reads from them.

namespace abbe::test {
namespace {

using namespace abbe::cli;

constexpr double kBlack = 64;
constexpr double kFull = 4095 - kBlack;

// Exposures of a step wedge by a 12-bit camera with this gamma, whose files record its levels.
std::filesystem::path write_series(double gamma = 1) {
  constexpr int kWidth = 96;
  constexpr int kHeight = 64;
  std::string listing;
  for (const double seconds : {0.25, 0.5, 1.0, 2.0}) {
    Image image{kWidth, kHeight, {}, {}};
    for (const char* name : {"R", "G", "B"}) {
      ImageChannel& plane = image.channels.emplace_back(ImageChannel{name, {}});
      for (int i = 0; i < kWidth * kHeight; ++i) {
        const double light = seconds * (i % kWidth + 1) / kWidth * 0.6;
        const double dn = kBlack + std::pow(light, 1 / gamma) * kFull;
        plane.values.push_back(static_cast<float>(std::min(4095.0, std::floor(dn + 0.5))));
      }
    }
    image.metadata = {{"exposure_s", fmt::format("{}", seconds)},
                      {"white_level_dn", "4095"},
                      {"sensor", fmt::format(R"({{"readout":{{"bits":12,"offset_dn":{}}}}})", kBlack)}};
    const std::string name = fmt::format("exposed_{}.tif", seconds);
    write_raw_picture(scratch() / name, image);
    listing += fmt::format(R"({}{{"file": "{}"}})", listing.empty() ? "" : ", ", name);
  }
  const auto path = scratch() / "series.json";
  std::ofstream(path) << R"({"exposures": [)" << listing << "]}";
  return path;
}

// Exposures of a step wedge in pictures without attributes: 16 bits that contain the 12 of a camera with this
// gamma.
std::filesystem::path write_picture_series(double gamma) {
  constexpr int kWidth = 96;
  std::string listing;
  for (const double seconds : {0.25, 0.5, 1.0, 2.0}) {
    Image image{kWidth, 12, {}, {}};
    for (const char* name : {"R", "G", "B"}) {
      ImageChannel& plane = image.channels.emplace_back(ImageChannel{name, {}});
      for (int i = 0; i < kWidth * 12; ++i) {
        const double light = std::min(1.0, seconds * (i % kWidth + 1) / kWidth * 0.6);
        plane.values.push_back(static_cast<float>(std::floor(4095 * std::pow(light, 1 / gamma) + 0.5)));
      }
    }
    const std::string name = fmt::format("picture_{}.tif", seconds);
    write_raw_picture(scratch() / name, image);
    listing +=
        fmt::format(R"({}{{"file": "{}", "exposure_s": {}}})", listing.empty() ? "" : ", ", name, seconds);
  }
  return scratch().write("pictures.json",
                         R"({"full_scale": 0.0624857, "bits": 12, "exposures": [)" + listing + "]}");
}

// Exposures through a mosaic whose channels are declared as B, G, R.
std::filesystem::path write_mosaic_series() {
  constexpr int kEdge = 32;
  std::string listing;
  for (const double seconds : {0.25, 0.5, 1.0, 2.0}) {
    Image image{kEdge, kEdge, {{"raw", {}}}, {}};
    for (int i = 0; i < kEdge * kEdge; ++i) {
      const double dn = kBlack + seconds * (i / 2 % (kEdge / 2) + 1) / (kEdge / 2) * 0.6 * kFull;
      image.channels[0].values.push_back(static_cast<float>(std::min(4095.0, std::floor(dn + 0.5))));
    }
    image.metadata = {{"exposure_s", fmt::format("{}", seconds)},
                      {"mosaic", "B,G/G,R"},
                      {"mosaic_channels", "B,G,R"},
                      {"white_level_dn", "4095"},
                      {"sensor", fmt::format(R"({{"readout":{{"bits":12,"offset_dn":{}}}}})", kBlack)}};
    const std::string name = fmt::format("mosaic_{}.tif", seconds);
    write_raw_picture(scratch() / name, image);
    listing += fmt::format(R"({}{{"file": "{}"}})", listing.empty() ? "" : ", ", name);
  }
  return scratch().write("mosaic_series.json", R"({"exposures": [)" + listing + "]}");
}

// Camera values of the chart under D65, with the perfect diffuser. One patch has a clipped green value.
CalibrateOptions measured(const std::string& unit, double white, const std::string& clipped = "") {
  CalibrateOptions options;
  options.how.bootstrap_draws = 2;
  options.measured = scratch() / "raw_patches.csv";
  Diagnostics diagnostics;
  const auto channels = load_camera("Nikon_D5100", {}, diagnostics);
  const auto chart = load_chart(options.chart, {}, diagnostics);
  const Curve lamp = load_illuminant("D65", {}, diagnostics)->curve;
  std::ofstream rows(options.measured);
  rows << "# unit: " << unit << "\npatch,R,G,B,R_saturated,G_saturated,B_saturated\n";
  for (const Patch& patch : chart->patches) {
    const bool is_clipped = clipped == "all" || patch.name == clipped;
    std::vector<double> raw = camera_raw(*channels, lamp, patch.reflectance);
    if (is_clipped) raw[1] *= 0.6;
    rows << fmt::format("{},{},{},{},0,{},0\n", patch.name, white * raw[0], white * raw[1], white * raw[2],
                        is_clipped ? 50 : 0);
  }
  return options;
}

TEST(CalibrateRaw, NumbersAboveBlackAreSharesOfWhatTheSeriesTells) {
  CalibrateOptions options = measured(kNumbersAboveBlack, 0.8 * kFull);
  const double plain = json_output(calibrate, options)["dE00_mean"];
  options.series = write_series();
  const json both = json_output(calibrate, options);
  EXPECT_NEAR(both["dE00_mean"].get<double>(), plain, 0.05) << "the response is a straight line";
}

// Camera values of the chart with this gamma. If noise is recorded, it is the same in linear light and
// therefore larger for dark codes.
std::filesystem::path write_chart(double gamma, bool is_noisy,
                                  const std::string& unit = "shares of full scale", double full = 1) {
  Diagnostics diagnostics;
  const auto channels = load_camera("Nikon_D5100", {}, diagnostics);
  const auto chart = load_chart(CalibrateOptions().chart, {}, diagnostics);
  const Curve lamp = load_illuminant("D65", {}, diagnostics)->curve;
  std::string rows = "# unit: " + unit + "\npatch,R,G,B";
  rows += is_noisy ? ",R_deviation,G_deviation,B_deviation,R_pixels,G_pixels,B_pixels\n" : "\n";
  for (const Patch& patch : chart->patches) {
    std::string values;
    std::string noise;
    for (const double raw : camera_raw(*channels, lamp, patch.reflectance)) {
      const double code = full * std::pow(0.8 * raw, 1 / gamma);
      values += fmt::format(",{}", code);
      noise += fmt::format(",{}", 0.01 * code / (gamma * 0.8 * raw));
    }
    rows += patch.name + values + (is_noisy ? noise + ",1,1,1\n" : "\n");
  }
  return scratch().write("chart_of_gamma.csv", rows);
}

// The noise affects the fit equally for linear values and for codes. So do the errors of the curve, with or
// without noise.
TEST(CalibrateRaw, NoiseIsMadeLinearWithTheValues) {
  CalibrateOptions options;
  options.how.bootstrap_draws = 2;
  options.how.fit.objective = Objective::xyz;
  const auto shifts = [&](double gamma) {
    std::vector<double> shift(24, 0);
    for (const bool is_noisy : {false, true}) {
      options.measured = write_chart(gamma, is_noisy);
      const json patches = json_output(calibrate, options)["patches"];
      for (std::size_t i = 0; i < 24; ++i)
        shift[i] += (is_noisy ? 1 : -1) * patches.at(i)["dE00"].get<double>();
    }
    return shift;
  };
  const std::vector<double> linear = shifts(1);
  options.series = write_series(2.2);
  const std::vector<double> curved = shifts(2.2);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_NEAR(curved[i], linear[i], 0.03) << i;
}

// The values of such pictures are fractions of 65535, or floats as stored. They clip at the level that the
// listing declares.
TEST(CalibrateRaw, ValuesOfPicturesAreSharesOfTheListedFullScale) {
  CalibrateOptions options;
  options.how.bootstrap_draws = 2;
  options.measured = write_chart(1, false);
  const double plain = json_output(calibrate, options)["dE00_mean"];
  options.series = write_picture_series(2.2);
  for (const char* unit : {kCodeValues, kFilmValues}) {
    options.measured = write_chart(2.2, false, unit, 4095.0 / 65535);
    EXPECT_NEAR(json_output(calibrate, options)["dE00_mean"].get<double>(), plain, 0.05) << unit;
  }
  options.measured = write_chart(2.2, false);
  EXPECT_NEAR(json_output(calibrate, options)["dE00_mean"].get<double>(), plain, 0.05) << "shares already";
}

TEST(CalibrateRaw, ResponsesAreMatchedWithMeasuredValuesByName) {
  CalibrateOptions options = measured(kNumbersAboveBlack, 0.8 * kFull);
  options.how.fit.objective = Objective::xyz;
  options.series = write_mosaic_series();
  const json responses = json_output(calibrate, options)["responses"];
  ASSERT_EQ(responses.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(responses[k]["channel"], std::string(1, "RGB"[k]));
}

TEST(CalibrateRaw, SaturatedPatchesAreLeftOutOfBalanceAndFit) {
  const double plain = json_output(calibrate, measured(kNumbersAboveBlack, 3000))["dE00_mean"];
  const CalibrateOptions clipped = measured(kNumbersAboveBlack, 3000, "white 9.5 (.05 D)");
  testing::internal::CaptureStderr();
  const json answer = json_output(calibrate, clipped);
  const std::string warnings = testing::internal::GetCapturedStderr();
  EXPECT_NE(warnings.find("patch \"white 9.5 (.05 D)\" has saturated pixels"), std::string::npos) << warnings;
  EXPECT_NE(warnings.find("it is excluded"), std::string::npos) << warnings;
  ASSERT_EQ(answer["patches"].size(), 23U);
  EXPECT_NEAR(answer["dE00_mean"].get<double>(), plain, 0.15);
  const CalibrateOptions all = measured(kNumbersAboveBlack, 3000, "all");
  testing::internal::CaptureStderr();
  EXPECT_EQ(fault([&] { calibrate(all); }, "24 of 24 have saturated pixels: expose less"), ErrorCode::input);
  (void)testing::internal::GetCapturedStderr();
}

TEST(CalibrateRaw, CodeValuesOfPicturesAreWarnedOfWhereNoSeriesMakesThemLinear) {
  const auto told = [](const CalibrateOptions& options) {
    testing::internal::CaptureStderr();
    (void)json_output(calibrate, options);
    return testing::internal::GetCapturedStderr();
  };
  CalibrateOptions options = measured(kCodeValues, 0.8);
  EXPECT_NE(told(options).find("raw_patches.csv: warning: its values are code values of a picture and count "
                               "as linear, but code values for displays are not linear"),
            std::string::npos);
  options.series = write_series();
  EXPECT_EQ(told(options).find("count as linear"), std::string::npos);
  EXPECT_EQ(told(measured("linear camera values", 0.8)), "");
}

TEST(CalibrateRaw, ScalesThatDoNotFitAreNamed) {
  MeasuredPatches raw{{"grey"}, {{300, 300, 300}}, {}, kNumbersAboveBlack};
  EXPECT_EQ(fault([&] { scale_to_codes(raw, {}, "m.csv"); }, "m.csv: its values are digital numbers above"),
            ErrorCode::input);
  MeasuredPatches clipped{{"grey"}, {{300, 300, 4003}}, {}, kNumbersAboveBlack, {"grey"}};
  scale_to_codes(clipped, {4000}, "m.csv");  // this patch is omitted, so it does not affect the fit
  EXPECT_EQ(clipped.values[0][0], 0.075);
  MeasuredPatches other{{"grey"}, {{0.3, 0.3, 300}}};
  MeasuredPatches dim{{"grey"}, {{0.01, 0.02, 0.04}}, {{0.001, 0.002, 0.003}}, kCodeValues};
  scale_to_codes(dim, {{}, 0.0625}, "m.csv");
  EXPECT_EQ(dim.values[0], (Raw{0.16, 0.32, 0.64}));
  EXPECT_EQ(dim.deviations[0], (Raw{0.016, 0.032, 0.048}));
  EXPECT_EQ(
      fault([&] { scale_to_codes(other, {4000}, "m.csv"); }, "patch \"grey\" has a value of 300 (allowed"),
      ErrorCode::input);
}

TEST(CalibrateRaw, LightsAreNamedOnce) {
  CalibrateOptions options;
  options.camera = "Nikon_D5100";
  options.illuminants = "D65,D65";
  options.output = scratch() / "twice";
  EXPECT_EQ(fault([&] { calibrate(options); }, "--illuminant: D65 is named twice"), ErrorCode::usage);
  options.illuminants = "lamp.csv,A,Lamp.csv";
  EXPECT_EQ(
      fault([&] { calibrate(options); },
            "--illuminant: Lamp.csv differs from lamp.csv only in case, which OpenColorIO ignores in names"),
      ErrorCode::usage);
}

TEST(CalibrateRaw, OneExposureTwiceIsASentenceAndNoReportOfTheSolver) {
  CalibrateOptions options;
  write_series();
  options.series = scratch() / "same.json";
  std::ofstream(options.series) << R"({"exposures": [{"file": "exposed_1.tif"}, {"file": "exposed_1.tif"}]})";
  testing::internal::CaptureStderr();
  EXPECT_THROW(calibrate(options), Error);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(CalibrateRaw, ChartsLieAsTheyArePrinted) {
  const std::vector<std::string> names(24, "patch");
  const std::array<Imath::V2d, 4> corners{{{0, 0}, {60, 0}, {60, 40}, {0, 40}}};
  const std::array<Imath::V2d, 4> mirrored{{{60, 0}, {0, 0}, {0, 40}, {60, 40}}};
  EXPECT_EQ(outlines_between(corners, names, 6).size(), 24U);
  EXPECT_EQ(fault([&] { (void)outlines_between(mirrored, names, 6); },
                  "--corners: these corners show the chart mirrored"),
            ErrorCode::usage);
  EXPECT_EQ(
      fault([&] { (void)outlines_between(corners, names, 7); }, "--columns: got 7, which does not divide"),
      ErrorCode::usage);
}

TEST(CalibrateRaw, PlotsAreSvg) {
  for (const char* command : {"query light D65", "transfer --dark x.tif --lit y.tif", "mtf x.exr"}) {
    const Outcome run = abbe(std::string(command) + " --plot " + (scratch() / "plot.txt").string());
    EXPECT_EQ(run.code, 2) << command;
    EXPECT_NE(run.err.find("allowed .svg"), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace abbe::test

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "cli/lab.h"
#include "cli/query.h"
#include "io/exr.h"
#include "io/spectral_exr.h"
#include "sensor/film/crop.h"
#include "spectral/library.h"
#include "tests/cli/json_output.h"
#include "tests/cli/program.h"

namespace abbe::test {
namespace {

using namespace abbe::cli;

TEST(QueryLight, JudgesALampAndDrawsIt) {
  LightOptions options{"FL11"};
  options.plot = scratch() / "fl11.svg";
  const json found = json_output(query_light, options);
  EXPECT_NEAR(found["CCT_K"].get<double>(), 4000.66, 0.01);
  EXPECT_NEAR(found["Ra"].get<double>(), 82.86, 0.1);
  EXPECT_NEAR(found["Rf"].get<double>(), 80.04, 0.17);
  EXPECT_EQ(found["R"].size(), 14u);
  for (const char* key : {"Rf_h", "Rcs_h", "Rhs_h"}) EXPECT_EQ(found[key].size(), 16u);
  const std::string drawn = read_file(options.plot);
  EXPECT_NE(drawn.find("<svg"), std::string::npos);
  EXPECT_NE(drawn.find("Rf 80"), std::string::npos);
  EXPECT_NE(drawn.find("Rg 101"), std::string::npos);
}

TEST(QueryLight, FiguresThatDoNotExistAreNeitherPrintedNorDrawn) {
  LightOptions options{"blackbody:1000"};
  options.plot = scratch() / "bb.svg";
  testing::internal::CaptureStdout();
  EXPECT_NO_THROW(query_light(options));
  const std::string printed = testing::internal::GetCapturedStdout();
  EXPECT_NE(printed.find("\nRg  -\n"), std::string::npos) << printed;
  const std::string drawn = read_file(options.plot);
  EXPECT_NE(drawn.find("Rg -<"), std::string::npos);
  for (const std::string& text : {printed, drawn}) EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  const json found = json_output(query_light, options);
  EXPECT_TRUE(found["Rg"].is_null());
  for (const char* key : {"Rf_h", "Rcs_h", "Rhs_h"}) {
    EXPECT_EQ(found[key].size(), 16u) << key;
    EXPECT_TRUE(found[key][3].is_null()) << key;
    EXPECT_FALSE(found[key][4].is_null()) << key;
  }
}

TEST(QueryLight, BlackBodiesHaveTheirTemperatures) {
  const auto kelvin = [](const LightOptions& options) {
    return json_output(query_light, options)["CCT_K"].get<double>();
  };
  EXPECT_NEAR(kelvin(LightOptions{"blackbody:20000"}), 20000, 0.2);
  EXPECT_NEAR(kelvin(LightOptions{"blackbody:99000"}), 99000, 0.99);
  LightOptions truncated{"blackbody:99000"};
  truncated.range = kVisibleRange;
  EXPECT_NEAR(kelvin(truncated), 96570, 10);
}

TEST(QueryLight, PrintsTheFidelityOfEachSampleOnDemand) {
  LightOptions options{"FL2"};
  EXPECT_FALSE(json_output(query_light, options).contains("Rs"));
  options.samples = true;
  const json found = json_output(query_light, options);
  EXPECT_EQ(found["Rs"].size(), 99U);
  double sum = 0;
  for (const double sample : found["Rs"]) sum += sample;
  EXPECT_NEAR(sum / 99, found["Rf"].get<double>(), 1.5) << "the scale is not linear near 0";
  EXPECT_NEAR(found["Rs"]["CES05"].get<double>(), 36, 0.65) << "of the calculator of TM-30";
  options.name = "blackbody:99000";
  EXPECT_TRUE(json_output(query_light, options)["Rs"].is_null()) << "without a reference";
}

TEST(QueryLight, SeesThroughFiltersAndFromSurfaces) {
  const json bare = json_output(query_light, LightOptions{"A"});
  const json filtered = json_output(query_light, LightOptions{"A", "kodak_wratten_400-700:W78"});
  EXPECT_GT(filtered["CCT_K"].get<double>(), bare["CCT_K"].get<double>() + 1000);  // a bluish filter
  const json twice =
      json_output(query_light, LightOptions{"A", "kodak_wratten_400-700:W78,kodak_wratten_400-700:W85"});
  EXPECT_LT(twice["CCT_K"].get<double>(), filtered["CCT_K"].get<double>());
  const json patch = json_output(
      query_light, LightOptions{"D65", "", "colorchecker24_babelcolor_average:neutral 5 (.70 D)"});
  EXPECT_NEAR(patch["CCT_K"].get<double>(), 6500, 200);
}

TEST(QueryLight, TellsNullOfWhatHasNoTemperature) {
  const json found = json_output(query_light, LightOptions{"D65", "bessell_B"});
  for (const char* key : {"CCT_K", "Duv", "Ra", "Rf", "Rg"}) EXPECT_TRUE(found[key].is_null()) << key;
  EXPECT_FALSE(found.contains("R"));
  LightOptions drawn{"D65", "bessell_B"};
  drawn.plot = scratch() / "none.svg";
  EXPECT_EQ(fault([&] { query_light(drawn); }, "no colour temperature"), ErrorCode::input);
  EXPECT_FALSE(std::filesystem::exists(drawn.plot));
}

TEST(QueryLight, ReadsPixelsOfASpectralImage) {
  // The left half is illuminated by A, the right half by FL2, in bands of 5 nm around the tabulated
  // wavelengths.
  Diagnostics diagnostics;
  const Curve a = load_illuminant("A", {}, diagnostics)->curve;
  const Curve fl2 = load_illuminant("FL2", {}, diagnostics)->curve;
  SpectralImage image{2, 1, {}, {}, {}};
  for (int nm = 380; nm <= 780; nm += 5)
    image.bands.push_back(
        {static_cast<double>(nm), {static_cast<float>(5 * a(nm)), static_cast<float>(5 * fl2(nm))}});
  const std::filesystem::path file = scratch() / "half.exr";
  write_exr(file, spectral_layout(image));
  LightOptions left{file.string()};
  left.crop = Crop{0, 0, 1, 1};
  LightOptions right = left;
  right.crop = Crop{1, 0, 2, 1};
  EXPECT_NEAR(json_output(query_light, left)["CCT_K"].get<double>(), 2855.65, 0.1);
  EXPECT_NEAR(json_output(query_light, right)["CCT_K"].get<double>(), 4225.05, 0.1);
  EXPECT_NEAR(json_output(query_light, right)["Ra"].get<double>(), 64.23, 0.1);
  const std::filesystem::path capitals = scratch() / "HALF.EXR";
  std::filesystem::copy_file(file, capitals, std::filesystem::copy_options::overwrite_existing);
  LightOptions same = right;
  same.name = capitals.string();
  EXPECT_EQ(json_output(query_light, same)["CCT_K"], json_output(query_light, right)["CCT_K"]);
  right.crop = Crop{1, 0, 3, 1};
  EXPECT_EQ(fault([&] { query_light(right); }, "allowed within 0,0,2,1"), ErrorCode::usage);
  image.metadata[kCropKey] = "1,0,2,1";
  write_exr(file, spectral_layout(image));
  right.crop.reset();
  EXPECT_NEAR(json_output(query_light, right)["Ra"].get<double>(), 64.23, 0.1);
  EXPECT_EQ(fault([&] { query_light(left); }, "allowed within 1,0,2,1"), ErrorCode::usage);
}

TEST(QueryLight, TellsWhatASpectralImageLacksOfTheLightAsked) {
  SpectralImage image{1, 1, {}, {}, {}};
  for (int nm = 505; nm < 600; nm += 10) image.bands.push_back({static_cast<double>(nm), {1}});
  const std::filesystem::path file = scratch() / "green.exr";
  write_exr(file, spectral_layout(image));
  const auto warnings = [&](const LightOptions& options) {
    testing::internal::CaptureStderr();
    json_output(query_light, options);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(warnings(LightOptions{file.string()}).find("covers only 500 to 600 nm, but"), std::string::npos);
  const auto filter =
      scratch().write("green.csv", "# unit: 1\n# outside: zero\nwavelength_nm,T\n510,0\n550,1\n590,0\n");
  EXPECT_EQ(warnings(LightOptions{file.string(), filter.string()}), "") << "no other light gets through";
}

TEST(QueryLight, IsOfNoPowerThatIsNegativeOrNoNumber) {
  const auto lamp =
      scratch().write("lamp.csv", "# unit: 1\n# outside: zero\nwavelength_nm,b\n400,-1\n700,1\n").string();
  EXPECT_EQ(fault([&] { query_light(LightOptions{lamp + ":b"}); }, "out of range at 400 nm (got -1"),
            ErrorCode::input);
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), -1.0F}) {
    const std::filesystem::path file = scratch() / "odd.exr";
    write_exr(file, spectral_layout({1, 1, {{500, {1}}, {550, {value}}, {600, {1}}}, {}, {}}));
    EXPECT_EQ(fault([&] { query_light(LightOptions{file.string()}); },
                    "odd.exr: has a radiance that is negative or not finite in the band at 550 nm"),
              ErrorCode::input);
  }
}

TEST(QueryLight, ObjectsInSentences) {
  LightOptions cropped{"D65"};
  cropped.crop = Crop{0, 0, 1, 1};
  EXPECT_EQ(fault([&] { query_light(cropped); }, "applies to spectral images only"), ErrorCode::usage);
  EXPECT_EQ(fault([] { query_light(LightOptions{"D66"}); }, "unknown illuminant \"D66\""), ErrorCode::input);
  EXPECT_EQ(fault(
                [] {
                  query_light(LightOptions{"D65", "no_filter"});
                },
                "unknown filter \"no_filter\""),
            ErrorCode::input);
  EXPECT_EQ(fault(
                [] {
                  query_light(LightOptions{"D65", "bessell_B,sdss2010_z"});
                },
                "no visible light"),
            ErrorCode::input);
}

TEST(Query, SharesInPercentAreRefusedByEveryCommand) {
  const std::string table =
      scratch().write("pc.csv", "# unit: %\n# outside: clamp\nwavelength_nm,T\n380,0.3\n780,0.6\n").string() +
      ":T";
  const auto expect_refused = [](const std::function<void()>& command) {
    EXPECT_EQ(fault(command, "has the wrong unit (got \"%\", allowed fractions of 1)"), ErrorCode::input);
  };
  expect_refused([&] { query_light(LightOptions{"D65", table}); });
  expect_refused([&] { query_light(LightOptions{"D65", "", table}); });
  expect_refused([&] { query_metamerism(MetamerismOptions{"cornell_box_walls:red", table}); });
  expect_refused([&] { query_camera(CameraOptions{"Nikon_D5100", "D65", table}); });
  for (const ColorMethod method : {ColorMethod::one_nm, ColorMethod::astm_e308})
    expect_refused([&] { query_color(ColorOptions{"D65", Observer::cie1931, table, false, method}); });
}

TEST(Query, TablesThatEndWithinWhatIsCountedAreTold) {
  const std::string lamp =
      scratch().write("short.csv", "# unit: 1\n# outside: zero\nwavelength_nm,L\n450,1\n650,1\n").string();
  const auto told = [](const std::function<void()>& command) {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    EXPECT_NO_THROW(command());
    testing::internal::GetCapturedStdout();
    return testing::internal::GetCapturedStderr();
  };
  const std::string ends = "short.csv\" is 0 outside its table, 450 to 650 nm";
  const auto expect_told = [&](const std::function<void()>& command) {
    const std::string said = told(command);
    EXPECT_NE(said.find(ends), std::string::npos) << said;
  };
  // The power is constant, and 200 of the 400 nm are outside the table.
  EXPECT_NE(
      told([&] {
        return query_light(LightOptions{lamp});
      }).find("50 % of the integral for the luminous efficacy of radiation from 380 to 780 nm would lie"),
      std::string::npos);
  expect_told([&] { return query_light(LightOptions{"D65", lamp}); });
  expect_told([&] {
    return query_metamerism(
        MetamerismOptions{"cornell_box_walls:red", "cornell_box_walls:green", "D65", lamp});
  });
  for (const ColorMethod method : {ColorMethod::one_nm, ColorMethod::astm_e308})
    expect_told([&] { return query_color(ColorOptions{lamp, Observer::cie1964, "", false, method}); });
  LabOptions bench;
  bench.material = R"({"diffuse": {"reflectance": 0.5}})";
  bench.at_nm = {550};
  bench.angles_deg = {0};
  bench.samples = 64;
  bench.illuminant = lamp;
  expect_told([&] { return lab(bench); });
  EXPECT_EQ(told([&] { return query_light(LightOptions{"FL2", "ir_cut_apertus:Hoya"}); }), "");
  EXPECT_EQ(told([&] { return query_color(ColorOptions{"D65", Observer::cie1964}); }), "");
}

TEST(QueryMetamerism, ComparesTwoSurfaces) {
  const json found = json_output(query_metamerism, MetamerismOptions{"colorchecker24_babelcolor_average:blue",
                                                                     "colorchecker24_ohta1997:blue"});
  EXPECT_GT(found["reference_dE76"].get<double>(), found["dE76"].get<double>());
  EXPECT_GT(found["dE00"].get<double>(), 0.1);
}

TEST(QueryCamera, IsJudgedWithoutALight) {
  CameraOptions options{"Nikon_D5100", "", ""};
  EXPECT_EQ(fault([&] { query_camera(options); }, "--illuminant or --judge"), ErrorCode::usage);
  options.metrics = true;
  const json found = json_output(query_camera, options);
  EXPECT_NEAR(found["vora"].get<double>(), 0.931, 1e-3);
  EXPECT_NEAR(found["sensitivity_index"].get<double>(), 90.78, 0.01);
  EXPECT_EQ(found["luther_residual"].size(), 3u);
}

// Energy responses of a camera as quantum efficiencies. Both are equal at `unity_nm`.
std::string as_quantum_efficiencies(double unity_nm) {
  Diagnostics diagnostics;
  const auto channels = load_camera("Nikon_D5100", {}, diagnostics);
  std::string rows =
      "# unit: quantum efficiency (electrons per photon)\n# outside: clamp\nwavelength_nm,R,G,B\n";
  for (int nm = 380; nm <= 780; nm += 5) {
    rows += std::to_string(nm);
    for (const Channel& channel : *channels) rows += "," + std::to_string(channel.weight(nm) * unity_nm / nm);
    rows += '\n';
  }
  return rows;
}

TEST(QueryCamera, TakesCurvesForWhatTheyAreSaidToMultiply) {
  CameraOptions options{scratch().write("q.csv", as_quantum_efficiencies(550)).string(), "A", ""};
  const json true_raw = json_output(query_camera, CameraOptions{"Nikon_D5100", "A", ""})["raw"];
  options.response = ResponseKind::quantum;
  testing::internal::CaptureStderr();
  const json raw = json_output(query_camera, options)["raw"];
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  for (const char* channel : {"R", "B"})
    EXPECT_NEAR(raw[channel].get<double>(), true_raw[channel].get<double>(), 2e-3) << channel;
  options.response.reset();
  testing::internal::CaptureStderr();
  EXPECT_LT(json_output(query_camera, options)["raw"]["R"], 0.95);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("is used as a response to energy"),
            std::string::npos);
}

// The CCD responds up to 1050 nm. D65 is tabulated up to 830 nm, A and E up to 1100 nm.
TEST(QueryCamera, TellsOfLightsThatEndWithinWhatItSees) {
  const auto said = [](const std::string& light) {
    testing::internal::CaptureStderr();
    json_output(query_camera, CameraOptions{"kodak_kaf-3200me", light, ""});
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(said("D65").find("\"D65\" is 0 outside its table, 300 to 830 nm"), std::string::npos);
  for (const char* light : {"A", "E"}) EXPECT_EQ(said(light), "");
  const std::string lamp =
      scratch().write("ended.csv", "# unit: 1\nwavelength_nm,L\n380,1\n780,1\n").string();
  EXPECT_EQ(fault(
                [&] {
                  query_camera(CameraOptions{"kodak_kaf-3200me", lamp, ""});
                },
                "covers 380 to 780 nm, but"),
            ErrorCode::input);
  EXPECT_NO_THROW(json_output(query_camera, CameraOptions{"Nikon_D5100", lamp, ""}));
}

TEST(QueryDeltaE, KnowsFormulasOfAppearanceAndDisplays) {
  // The colours are red and white of sRGB relative to D65, as in `itp_srgb` of the reference tables.
  const json found =
      json_output(query_delta_e, DeltaEOptions{{53.2407933, 80.0924696, 67.2031964}, {100, 0, 0}});
  EXPECT_NEAR(found["dE_ITP"].get<double>(), 232.6248, 0.01);
  EXPECT_GT(found["dE_CAM16_UCS"].get<double>(), 30);
  const json none = json_output(query_delta_e, DeltaEOptions{{50, 20, -30}, {50, 20, -30}});
  EXPECT_EQ(none["dE_CAM16_UCS"].get<double>(), 0);
  EXPECT_EQ(none["dE_ITP"].get<double>(), 0);
}

TEST(QueryLight, ColoursBeyondAllColoursAreRefused) {
  const Outcome run = abbe("query delta-e 1e308,0,0 50,10,0");
  EXPECT_EQ(run.code, 2) << run.out;
  EXPECT_NE(run.err.find("allowed [-1000000, 1000000]"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace abbe::test

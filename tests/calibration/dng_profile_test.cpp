#include "calibration/output/camera_profile.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "calibration/camera_calibration.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

using test::expect_near;

CameraCalibration calibration(const std::string& light, const std::string& response = "") {
  CharacterisationOptions options;
  options.bootstrap_draws = 2;
  return calibrate_camera(
      {"Nikon_D5100", light, response, 0, test::camera(), test::illuminant(light), test::chart()}, options);
}

TEST(DngProfile, TakesWhiteToWhiteBothWays) {
  const CameraCalibration made = calibration("A");
  const auto light = dng_light(made.profile, made.colors.white);
  ASSERT_TRUE(light);
  EXPECT_EQ(light->code, 17);
  EXPECT_NEAR(light->kelvin, 2855.63, 0.01);
  expect_near(multiply(light->forward, {1, 1, 1}), dng_white(), 1e-12);
  // The colour matrix maps the light's white to the camera's, whose largest value is 1.
  const Raw camera_white = white_values(made.profile);
  const double greatest = std::max({camera_white[0], camera_white[1], camera_white[2]});
  const auto found = multiply(light->color, made.colors.white);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], camera_white[k] / greatest, 1e-12);
}

TEST(DngProfile, SuitsASensorWithTheSameChannelsInAnotherOrder) {
  const RawLight light{21, {1, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 3, 4, 5, 6, 7, 8, 9}};
  const auto suited = [&light](const std::vector<std::string>& channels) {
    return light_for(channels, light);
  };
  const RawLight turned = suited({"G", "B", "R"});
  EXPECT_EQ(turned.color, (std::array<double, 9>{4, 5, 6, 7, 8, 9, 1, 2, 3})) << "rows are channels";
  EXPECT_EQ(turned.forward, (std::array<double, 9>{2, 3, 1, 5, 6, 4, 8, 9, 7})) << "columns are";
  for (const std::vector<std::string>& others : {std::vector<std::string>{"C", "M", "Y"}, {"R", "G", "B"}}) {
    EXPECT_EQ(suited(others).color, light.color);
    EXPECT_EQ(suited(others).forward, light.forward);
  }
}

TEST(ExifLight, NumbersStandardLightsAndKindsOfFluorescentLamps) {
  for (const auto& [name, number] : {std::pair{"A", 17},
                                     {"B", 18},
                                     {"C", 19},
                                     {"D55", 20},
                                     {"D65", 21},
                                     {"D75", 22},
                                     {"D50", 23},
                                     {"FL1", 12},
                                     {"FL10", 13},
                                     {"FL2", 14},
                                     {"FL11", 14},
                                     {"FL3", 15},
                                     {"FL4", 16},
                                     {"FL12", 16},
                                     {"LED-B3", 255},
                                     {"E", 255},
                                     {"FLASH", 255}})
    EXPECT_EQ(exif_light_source(std::string(name)), number) << name;
  for (const auto& [name, number] :
       {std::pair{"A", 17}, {"D65", 21}, {"D50", 23}, {"FL2", 14}, {"FL4", 16}, {"LED-B1", 255}})
    EXPECT_EQ(exif_light_source(chromaticity(test::illuminant(name))), number) << name;
}

// Names and aliases of lights in the data directory.
TEST(ExifLight, KnowsLightsByTheirOtherNames) {
  for (const auto& [name, number] : {std::pair{"F11", 14},
                                     {"F1", 12},
                                     {"cie_FL1-12:FL4", 16},
                                     {"cie_A", 17},
                                     {"cie_D65", 21},
                                     {"cie_D65:D65", 21},
                                     {"HP1", 255},
                                     {"daylight:6500", 255}})
    EXPECT_EQ(exif_light_source(std::string(name)), number) << name;
}

// The table's light has nearly the temperature of day white fluorescent light, number 13.
TEST(ExifLight, TakesNoTableOfAUserForAStandardLight) {
  const std::filesystem::path before = std::filesystem::current_path();
  const auto folder =
      std::filesystem::temp_directory_path() / ("abbe_exif_light_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  std::filesystem::current_path(folder);
  for (const char* name : {"FLOOD.csv", "cie_D65.csv"})
    std::ofstream(name) << "# unit: 1\n# outside: clamp\nwavelength_nm,FL1,D65\n300,1,1\n830,1,1\n";
  for (const char* name : {"FLOOD.csv:FL1", "FLOOD.csv:D65", "cie_D65.csv:D65"})
    EXPECT_EQ(exif_light_source(std::string(name)), 255) << name;
  std::filesystem::current_path(before);
  std::filesystem::remove_all(folder);
}

TEST(DngProfile, MixesByReciprocalTemperature) {
  const CameraCalibration a = calibration("A");
  const CameraCalibration d65 = calibration("D65");
  const DngLight warm = dng_light(a.profile, a.colors.white).value();
  const DngLight cool = dng_light(d65.profile, d65.colors.white).value();
  const auto entry = [](const Matrix3& m) { return m[0][0]; };
  EXPECT_EQ(entry(forward_between(warm, cool, 2000)), entry(warm.forward));
  EXPECT_EQ(entry(forward_between(warm, cool, 10000)), entry(cool.forward));
  const double middle = 2 / (1 / warm.kelvin + 1 / cool.kelvin);
  EXPECT_NEAR(entry(forward_between(warm, cool, middle)), (entry(warm.forward) + entry(cool.forward)) / 2,
              1e-12);
}

TEST(DngProfile, IsNoneForRootPolynomials) {
  CameraCalibration made = calibration("D65");
  made.profile.correction = test::kRootPolynomial;
  EXPECT_FALSE(dng_light(made.profile, made.colors.white));
}

TEST(Sensitivities, AreReadBackAsTheCamera) {
  const std::vector<Channel> camera = test::camera();
  const auto file = std::filesystem::path(testing::TempDir()) /
                    ("abbe_sensitivities_" + std::to_string(::getpid()) + ".json");
  std::ofstream(file) << sensitivities_json("a \"camera\" named in Latin-1: caf\xE9", camera);
  Diagnostics diagnostics;
  const auto read = load_camera(file.string(), {}, diagnostics);
  ASSERT_TRUE(read) << diagnostics.text();
  std::filesystem::remove(file);
  ASSERT_EQ(read->size(), 3U);
  const double scale = (*read)[1].weight(530) / camera[1].weight(530);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ((*read)[k].name, camera[k].name);
    EXPECT_EQ((*read)[k].kind, ResponseKind::energy);
    for (int nm = 400; nm <= 700; nm += 5)
      EXPECT_NEAR((*read)[k].weight(nm), scale * camera[k].weight(nm), 1e-8) << nm;
  }
}

}  // namespace
}  // namespace abbe

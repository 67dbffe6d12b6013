#include "sensor/response/channel.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace abbe {
namespace {

class CameraJson : public testing::Test {
 protected:
  std::optional<std::vector<Channel>> read(const std::string& units, const std::string& main,
                                           const std::string& names = R"(["R", "G", "B"])") {
    diagnostics_ = {};
    std::ofstream(path_) << R"({"header": {"schema_version": "0.1.0", "model": "d1", "license": null},
      "spectral_data": {"units": ")"
                         << units << R"(", "bandwidth_FWHM": null, "index": {"main": )" << names
                         << R"(}, "data": {"main": {)" << main << "}}}}";
    return load_camera(path_.string(), {}, diagnostics_);
  }
  void TearDown() override { std::filesystem::remove(path_); }

  void expect_complaint(const std::string& text) {
    EXPECT_NE(diagnostics_.text().find(text), std::string::npos) << diagnostics_.text();
  }

  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / ("abbe_camera_" + std::to_string(::getpid()) + ".json");
  Diagnostics diagnostics_;
};

TEST_F(CameraJson, IsACameraByItsFile) {
  const auto camera =
      read("relative", R"("400": [0.1, 0.2, 0.9], "500": [0.3, 1.0, 0.5], "600": [1.0, 0.4, 0.0])");
  ASSERT_TRUE(camera) << diagnostics_.text();
  ASSERT_EQ(camera->size(), 3U);
  EXPECT_EQ((*camera)[1].name, "G");
  EXPECT_EQ((*camera)[1].kind, ResponseKind::energy);
  EXPECT_DOUBLE_EQ((*camera)[0].weight(400), 0.1);
  EXPECT_DOUBLE_EQ((*camera)[1].weight(450), 0.6);
  EXPECT_DOUBLE_EQ((*camera)[2].weight(550), 0.25);
  EXPECT_EQ((*camera)[2].weight(390), 0);
  EXPECT_EQ((*camera)[0].weight(610), 0);
  const auto counted = load_camera(path_.string(), {}, diagnostics_, ResponseKind::quantum);
  ASSERT_TRUE(counted);
  EXPECT_EQ((*counted)[0].kind, ResponseKind::quantum);
}

TEST_F(CameraJson, SaysWhereItIsWrong) {
  EXPECT_FALSE(read("nm", R"("400": [1, 1, 1], "500": [1, 1, 1])"));
  expect_complaint("/spectral_data/units");
  EXPECT_FALSE(read("relative", R"("400": [1, 1, 1], "390": [1, 1, 1])"));
  expect_complaint("got wavelength 390, allowed ascending numbers of nm in [300, 1100]");
  EXPECT_FALSE(read("relative", R"("0.4": [1, 1, 1], "0.5": [1, 1, 1])"));
  expect_complaint("got wavelength 0.4");
  EXPECT_FALSE(read("relative", R"("400": [1, 1], "500": [1, 1, 1])"));
  expect_complaint("/spectral_data/data/main/400");
  EXPECT_FALSE(read("relative", R"("400": [1, 1, 1])"));
  expect_complaint("expected two wavelengths or more");
  EXPECT_FALSE(read("relative", R"("400": [1, 1, 1], "500": [1, 1, 1])", "[]"));
  expect_complaint("expected the names of the channels");
  std::ofstream(path_) << R"({"spectral_data": {"units": "relative", "index": {}}})";
  diagnostics_ = {};
  EXPECT_FALSE(read_camera_json(path_, diagnostics_));
  expect_complaint("/spectral_data/index: error: missing key \"main\"");
}

}  // namespace
}  // namespace abbe

#include "calibration/output/ocio.h"

#include <OpenColorIO/OpenColorIO.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <random>

#include "calibration/fit/response.h"
#include "calibration/output/color_spaces.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

namespace OCIO = OCIO_NAMESPACE;
using Rgb = std::array<double, 3>;

CameraProfile profile() {
  CameraProfile p{"test camera", {}, Matrix3(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2)};
  const double gammas[] = {1.8, 2.2, 1.4};
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 0; i < 4096; ++i) p.linearisation[k].push_back(std::pow(i / 4095.0, gammas[k]));
  return p;
}

Rgb linear_xyz(const CameraProfile& p, const Rgb& code) {
  Rgb linear{};
  for (std::size_t k = 0; k < 3; ++k) linear[k] = linearise(p.linearisation[k], code[k]);
  return multiply(p.to_xyz_d65, linear);
}

Rgb run(const OCIO::ConstProcessorRcPtr& processor, const Rgb& in) {
  float rgb[3];
  for (std::size_t k = 0; k < 3; ++k) rgb[k] = static_cast<float>(in[k]);
  processor->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS)->applyRGB(rgb);
  return {rgb[0], rgb[1], rgb[2]};
}

void expect_near(const Rgb& a, const Rgb& b, double margin) {
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(a[k], b[k], margin) << testing::PrintToString(a) << " and " << testing::PrintToString(b);
}

std::vector<Rgb> codes() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> code(0, 1);
  std::vector<Rgb> all{{0, 0, 0}, {1, 1, 1}};
  for (int i = 0; i < 200; ++i) all.push_back({code(random), code(random), code(random)});
  return all;
}

class WrittenConfig : public testing::Test {
 protected:
  void SetUp() override {
    write_ocio_config(folder_, profile());
    config_ = OCIO::Config::CreateFromFile((folder_ / "config.ocio").c_str());
  }
  void TearDown() override { std::filesystem::remove_all(folder_.parent_path()); }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("abbe_ocio_test_" + std::to_string(::getpid())) / "nested";
  OCIO::ConstConfigRcPtr config_;
};

TEST_F(WrittenConfig, IsValidVersionTwoWithItsRoles) {
  EXPECT_NO_THROW(config_->validate());
  EXPECT_EQ(config_->getMajorVersion(), 2U);
  for (const char* role : {"aces_interchange", "cie_xyz_d65_interchange", "scene_linear", "default"})
    EXPECT_TRUE(config_->hasRole(role)) << role;
  EXPECT_EQ(config_->getColorSpace("cie_xyz_d65_interchange")->getReferenceSpaceType(),
            OCIO::REFERENCE_SPACE_DISPLAY);
}

TEST_F(WrittenConfig, CameraAgreesWithDoublePrecisionAndBack) {
  const auto forward = config_->getProcessor(kCameraSpace, "Linear XYZ-D65");
  const auto back = config_->getProcessor("Linear XYZ-D65", kCameraSpace);
  for (const Rgb& code : codes()) {
    expect_near(run(forward, code), linear_xyz(profile(), code), 1e-5);
    // Near black a power's inverse is too steep for single precision.
    if (std::min({code[0], code[1], code[2]}) > 0.02) expect_near(run(back, run(forward, code)), code, 1e-4);
  }
}

TEST_F(WrittenConfig, ClfHoldsTheSameTransform) {
  const OCIO::FileTransformRcPtr clf = OCIO::FileTransform::Create();
  clf->setSrc(kClfFile);
  const auto processor = config_->getProcessor(clf);
  for (const Rgb& code : codes()) expect_near(run(processor, code), linear_xyz(profile(), code), 1e-5);
}

TEST_F(WrittenConfig, ScenesSpacesShareOneWhite) {
  const auto aces = config_->getProcessor("ACES2065-1", "scene_linear");
  expect_near(run(aces, {1, 1, 1}), {1, 1, 1}, 1e-6);
  const auto xyz = config_->getProcessor("Linear XYZ-D65", "scene_linear");
  expect_near(run(xyz, unit_xyz(kD65)), {1, 1, 1}, 1e-6);
  const auto display = config_->getProcessor("scene_linear", kDisplay, kView, OCIO::TRANSFORM_DIR_FORWARD);
  expect_near(run(display, {0.18, 0.5, 1}),
              {1.055 * std::pow(0.18, 1 / 2.4) - 0.055, 1.055 * std::pow(0.5, 1 / 2.4) - 0.055, 1}, 2e-6);
}

TEST(OcioConfig, LinearCameraNeedsNoFile) {
  const std::string text = ocio_config_text({"linear", {}, Matrix3()});
  EXPECT_EQ(text.find("FileTransform"), std::string::npos);
  EXPECT_NE(text.find("ocio_profile_version: 2"), std::string::npos);
}

TEST(OcioConfig, RefusesUnequalCurves) {
  CameraProfile p = profile();
  p.linearisation[1].pop_back();
  test::expect_error([&] { static_cast<void>(ocio_config_text(p)); }, ErrorCode::internal, "one common size");
}

TEST(OcioConfig, RefusesAFileInPlaceOfTheFolder) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("abbe_ocio_file_" + std::to_string(::getpid()));
  std::ofstream(file) << "taken";
  test::expect_error([&] { write_ocio_config(file, profile()); }, ErrorCode::output, file.string());
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace abbe

#include "calibration/output/display.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "calibration/output/ocio.h"
#include "spectral/rgb.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

using test::expect_near;

const std::array<std::string, 3> kRgb{"R", "G", "B"};

CameraProfile profile(const std::string& light, double red_gain, bool is_curved = false) {
  const ColorCorrection matrix =
      linear_correction(Matrix3(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2));
  const XYZ white = matrix({1, 1, 1});
  CameraProfile made{
      light, "test camera", {}, {red_gain, 4, 5}, matrix, adaptation(white, unit_xyz(kD65)).value()};
  made.adaptation *= 1 / white[1];
  for (std::size_t k = 0; is_curved && k < 3; ++k) made.linearisation[k] = {0, 0.1, 1};
  return made;
}

class CameraMatrixTest : public testing::Test {
 protected:
  ~CameraMatrixTest() override { std::filesystem::remove_all(folder_); }
  ViewOptions view_of(const std::vector<CameraProfile>& profiles) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "config.ocio") << ocio_config_text(profiles);
    return {folder_ / "config.ocio", "", ""};
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("abbe_camera_matrix_" + std::to_string(::getpid()));
};

// A neutral of a film has the values of the perfect diffuser in any unit, and its Y is the value of G.
TEST_F(CameraMatrixTest, TakesNeutralsToWhiteInUnitsOfTheSecondChannel) {
  for (const bool is_curved : {false, true}) {
    const CameraProfile camera = profile("D65", 8, is_curved);
    const CameraMatrix found = camera_matrix(view_of({camera}), kRgb, "dome", {}).value();
    EXPECT_EQ(found.space, "Camera D65");
    const XYZ white = unit_xyz(kD65);
    constexpr double kFilmValue = 3e12;
    const std::array<double, 3> neutral{kFilmValue * 4 / 8, kFilmValue, kFilmValue * 4 / 5};
    const XYZ xyz = multiply(found.to_xyz_d65, neutral);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(xyz[k] / kFilmValue, white[k], 1e-6) << is_curved;
    const Matrix3 expected = matrix_to_xyz_d65(camera) * (1 / 4.0);
    expect_near(multiply(found.to_xyz_d65, {1, 0, 0}), multiply(expected, {1, 0, 0}), 1e-6);
    const std::array<std::string, 3> turned{"B", "R", "G"};
    const CameraMatrix ordered = camera_matrix(view_of({camera}), turned, "dome", {}).value();
    const XYZ same = multiply(ordered.to_xyz_d65, {neutral[2], neutral[0], neutral[1]});
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(same[k] / same[1], white[k], 1e-6) << k;
  }
}

TEST_F(CameraMatrixTest, ChoosesTheSpaceOfTheFilmsWhite) {
  const ViewOptions view = view_of({profile("A", 8), profile("D65", 6), profile("my lamp", 7)});
  const auto space = [&](const std::string& name, std::optional<Chromaticity> white) {
    return camera_matrix(view, kRgb, name, white).value().space;
  };
  EXPECT_EQ(space("my lamp", kD65), "Camera my lamp");
  EXPECT_EQ(space("dome", kD65), "Camera D65");
  EXPECT_EQ(space("bulb", Chromaticity{0.45, 0.41}), "Camera A");
  test::expect_error([&] { (void)camera_matrix(view, kRgb, "dome", {}); }, ErrorCode::usage,
                     "allowed a white among Camera A, Camera D65, Camera my lamp");
}

TEST_F(CameraMatrixTest, LeavesOtherSensorsAndConfigurationsAlone) {
  const ViewOptions view = view_of({profile("D65", 8)});
  EXPECT_FALSE(camera_matrix(view, std::array<std::string, 3>{"X", "Y", "Z"}, "D65", kD65));
  EXPECT_FALSE(camera_matrix(view, std::array<std::string, 1>{"V"}, "D65", kD65));
  EXPECT_FALSE(camera_matrix({}, kRgb, "D65", kD65));
  EXPECT_FALSE(camera_matrix(view_of({}), kRgb, "D65", kD65));
}

TEST_F(CameraMatrixTest, RefusesARootPolynomial) {
  CameraProfile polynomial = profile("D65", 8);
  polynomial.correction = test::kRootPolynomial;
  const ViewOptions view = view_of({polynomial});
  test::expect_error([&] { (void)camera_matrix(view, kRgb, "D65", kD65); }, ErrorCode::usage,
                     "\"Camera D65\" is not a matrix");
}

}  // namespace
}  // namespace abbe

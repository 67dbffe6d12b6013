#include "calibration/output/ocio.h"

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <random>
#include <span>
#include <tuple>

#include "calibration/chart/delta_e.h"
#include "calibration/fit/response.h"
#include "calibration/output/color_spaces.h"
#include "spectral/rgb.h"
#include "tests/calibration/calibration_fixture.h"
#include "tests/tier.h"

namespace abbe {
namespace {

namespace OCIO = OCIO_NAMESPACE;
using Rgb = std::array<double, 3>;
using test::expect_near;

const ColorCorrection kMatrix = linear_correction(Matrix3(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2));
CameraProfile profile(const std::string& light = "D65", const ColorCorrection& correction = kMatrix) {
  CameraProfile p{light,      "test camera",
                  {},         {1.1, 0.9, 1.2},
                  correction, adaptation(unit_xyz({0.34567, 0.3585}), unit_xyz(kD65)).value()};
  const double gammas[] = {1.8, 2.2, 1.4};
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 0; i < 4096; ++i) p.linearisation[k].push_back(std::pow(i / 4095.0, gammas[k]));
  return p;
}

Rgb linear_xyz(const CameraProfile& p, const Rgb& code) {
  Rgb linear{};
  for (std::size_t k = 0; k < 3; ++k) linear[k] = linearise(p.linearisation[k], code[k]);
  return to_xyz_d65(p, linear);
}

Rgb run(const OCIO::ConstProcessorRcPtr& processor, const Rgb& in) {
  float rgb[3];
  for (std::size_t k = 0; k < 3; ++k) rgb[k] = static_cast<float>(in[k]);
  processor->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS)->applyRGB(rgb);
  return {rgb[0], rgb[1], rgb[2]};
}

std::vector<Rgb> codes() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> code(0, 1);
  std::vector<Rgb> all{{0, 0, 0}, {1, 1, 1}};
  for (int i = 0; i < 200; ++i) all.push_back({code(random), code(random), code(random)});
  return all;
}

// The configuration of these cameras in a temporary folder.
class WrittenFolder {
 public:
  explicit WrittenFolder(std::span<const CameraProfile> profiles)
      : written_(write_ocio_config(path_, profiles)),
        config_(OCIO::Config::CreateFromFile((path_ / "config.ocio").c_str())) {}
  WrittenFolder(const WrittenFolder&) = delete;
  WrittenFolder& operator=(const WrittenFolder&) = delete;
  ~WrittenFolder() { std::filesystem::remove_all(path_.parent_path()); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const WrittenConfig& written() const { return written_; }
  [[nodiscard]] const OCIO::ConstConfigRcPtr& config() const { return config_; }

 private:
  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / ("abbe_ocio_test_" + std::to_string(::getpid())) / "nested";
  WrittenConfig written_;
  OCIO::ConstConfigRcPtr config_;
};

// Configuration of one camera with a matrix, which is written quickly.
class OcioFolder : public testing::Test {
 protected:
  static std::filesystem::path written_folder_of(const CameraProfile& linear) {
    const std::filesystem::path folder = folder_->path().parent_path() / "linear";
    (void)write_ocio_config(folder, std::array{linear});
    return folder / "config.ocio";
  }
  static void SetUpTestSuite() {
    folder_.emplace(std::array{profile()});
    config_ = folder_->config();
  }
  static void TearDownTestSuite() {
    config_.reset();
    folder_.reset();
  }

  static inline std::optional<WrittenFolder> folder_;
  static inline OCIO::ConstConfigRcPtr config_;
};

TEST_F(OcioFolder, IsValidVersionTwoWithItsRoles) {
  EXPECT_NO_THROW(config_->validate());
  EXPECT_EQ(config_->getMajorVersion(), 2U);
  for (const char* role : {"aces_interchange", "cie_xyz_d65_interchange", "scene_linear", "default", "data",
                           "rendering", "color_picking", "texture_paint", "matte_paint"})
    EXPECT_TRUE(config_->hasRole(role)) << role;
  EXPECT_EQ(config_->getColorSpace("cie_xyz_d65_interchange")->getReferenceSpaceType(),
            OCIO::REFERENCE_SPACE_DISPLAY);
}

TEST_F(OcioFolder, CameraAgreesWithDoublePrecisionAndBack) {
  const auto forward = config_->getProcessor("Camera D65", "Linear XYZ-D65");
  const auto back = config_->getProcessor("Linear XYZ-D65", "Camera D65");
  for (const Rgb& code : codes()) {
    expect_near(run(forward, code), linear_xyz(profile(), code), 1e-5);
    // Near black, the inverse of a power is too steep for single precision.
    if (std::min({code[0], code[1], code[2]}) > 0.02) expect_near(run(back, run(forward, code)), code, 1e-4);
  }
}

TEST_F(OcioFolder, TellsTheScaleOfItsInput) {
  // A profile with a matrix that preserves white maps the linear values of the diffuser to white.
  CameraProfile linear =
      profile("D50", linear_correction(Matrix3(0.6, 0.26422, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 0.97521)));
  linear.linearisation = {};
  const auto config = OCIO::Config::CreateFromFile(written_folder_of(linear).c_str());
  const Raw white = white_values(linear);
  expect_near(run(config->getProcessor("Camera D50", "Linear XYZ-D65"), white), to_xyz_d65(linear, white),
              1e-6);
  EXPECT_NEAR(run(config->getProcessor("Camera D50", "Linear XYZ-D65"), white)[1], 1, 1e-5);
  const std::string told = config->getColorSpace("Camera D50")->getDescription();
  EXPECT_NE(
      told.find("Input: linear camera values; the perfect diffuser, which becomes Y = 1, has R 0.909091, G "
                "1.11111, B 0.833333"),
      std::string::npos)
      << told;
  const std::string curved = config_->getColorSpace("Camera D65")->getDescription();
  EXPECT_NE(curved.find("code values, 1 at full scale"), std::string::npos) << curved;
}

TEST_F(OcioFolder, ClfHoldsTheSameTransform) {
  const OCIO::FileTransformRcPtr clf = OCIO::FileTransform::Create();
  clf->setSrc("camera_D65.clf");
  const auto processor = config_->getProcessor(clf);
  for (const Rgb& code : codes()) expect_near(run(processor, code), linear_xyz(profile(), code), 1e-5);
}

TEST_F(OcioFolder, AcesInputTransformAgreesWithDoublePrecision) {
  const OCIO::FileTransformRcPtr clf = OCIO::FileTransform::Create();
  clf->setSrc("camera_D65_to_aces.clf");
  const auto processor = config_->getProcessor(clf);
  const auto through_config = config_->getProcessor("Camera D65", "aces_interchange");
  const Matrix3 to_aces = rgb_to_xyz_d65(kAces2065).inverse();
  for (const Rgb& code : codes()) {
    expect_near(run(processor, code), multiply(to_aces, linear_xyz(profile(), code)), 1e-5);
    expect_near(run(processor, code), run(through_config, code), 1e-6);
  }
}

TEST_F(OcioFolder, BuiltInTransformsAgreeWithTheSpacesOfTheProgram) {
  const auto aces = config_->getProcessor("ACEScg", "ACES2065-1");
  const Matrix3 expected = rgb_to_xyz_d65(kAces2065).inverse() * rgb_to_xyz_d65(kAcesCg);
  expect_near(run(aces, {0.2, 0.5, 0.9}), multiply(expected, {0.2, 0.5, 0.9}), 1e-6);
  const OCIO::BuiltinTransformRcPtr builtin = OCIO::BuiltinTransform::Create();
  builtin->setStyle("UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD");
  expect_near(run(config_->getProcessor("ACES2065-1", "Linear XYZ-D65"), {0.2, 0.5, 0.9}),
              run(config_->getProcessor(builtin), {0.2, 0.5, 0.9}), 1e-6);
}

TEST_F(OcioFolder, DisplaysEncodeAsTheirStandardsSay) {
  const Rgb linear{0.18, 0.5, 1};
  const auto shown = [&](const char* display, const RgbSpace& space) {
    const auto processor =
        config_->getProcessor(kReferenceSpace, display, kPlainView, OCIO::TRANSFORM_DIR_FORWARD);
    return run(processor, multiply(rgb_to_xyz(space), linear));
  };
  const auto power = [&](double gamma) {
    return Rgb{std::pow(linear[0], 1 / gamma), std::pow(linear[1], 1 / gamma),
               std::pow(linear[2], 1 / gamma)};
  };
  expect_near(shown(kRec1886Display, kRec709), power(2.4), 2e-6);
  expect_near(shown(kP3Display, kP3D65), power(2.6), 2e-6);
}

// The mid-grey of ACES 1.0 is a tenth of the white of a dark cinema minus its black, brightened for dim
// surroundings by the power 0.9811 [ACES-CTL].
TEST_F(OcioFolder, AcesViewPutsMiddleGreyWhereAcesDoes) {
  const auto aces =
      config_->getProcessor("ACES2065-1", kRec1886Display, kAcesView, OCIO::TRANSFORM_DIR_FORWARD);
  const Rgb grey = run(aces, {0.18, 0.18, 0.18});
  const double code = grey[1];
  for (const double v : grey) EXPECT_NEAR(v, code, 1e-4);
  EXPECT_NEAR(std::pow(code, 2.4), std::pow((4.8 - 0.02) / (48 - 0.02), 0.9811), 5e-4);
}

TEST_F(OcioFolder, ScenesSpacesShareOneWhite) {
  const auto aces = config_->getProcessor("ACES2065-1", "scene_linear");
  expect_near(run(aces, {1, 1, 1}), {1, 1, 1}, 1e-6);
  const auto xyz = config_->getProcessor("Linear XYZ-D65", "scene_linear");
  expect_near(run(xyz, unit_xyz(kD65)), {1, 1, 1}, 1e-6);
  const auto display =
      config_->getProcessor("Linear Rec.709 (sRGB)", kSrgbDisplay, kPlainView, OCIO::TRANSFORM_DIR_FORWARD);
  expect_near(run(display, {0.18, 0.5, 1}),
              {1.055 * std::pow(0.18, 1 / 2.4) - 0.055, 1.055 * std::pow(0.5, 1 / 2.4) - 0.055, 1}, 2e-6);
}

// Largest CIEDE2000 of a cube over random linear values from 0.2 % of its end on. The values are uniform over
// the steps of the cube, as the colours of a picture are.
double largest_loss(const CameraProfile& camera, const OCIO::ConstProcessorRcPtr& from_linear, double end) {
  const auto processor = from_linear->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS);
  const XYZ white = unit_xyz(kD65);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> root(std::cbrt(0.002), 1);
  const auto value = [&] { return end * std::pow(root(random), 3); };
  double largest = 0;
  for (int i = 0; i < 50000; ++i) {
    const Rgb linear{value(), value(), value()};
    float rgb[3] = {static_cast<float>(linear[0]), static_cast<float>(linear[1]),
                    static_cast<float>(linear[2])};
    processor->applyRGB(rgb);
    const Lab shown = xyz_to_lab(XYZ{rgb[0], rgb[1], rgb[2]}, white);
    largest = std::max(largest, delta_e_2000(xyz_to_lab(to_xyz_d65(camera, linear), white), shown));
  }
  return largest;
}

void expect_fine_cube(const WrittenFolder& folder) {
  EXPECT_GT(folder.written().bake_error, 0);
  EXPECT_LT(folder.written().bake_error, 0.2);
  const CameraProfile root = profile("blackbody:3200", test::kRootPolynomial);
  const auto processor = folder.config()->getProcessor("Camera blackbody:3200", "Linear XYZ-D65");
  const OCIO::FileTransformRcPtr clf = OCIO::FileTransform::Create();
  clf->setSrc("camera_blackbody_3200.clf");
  const auto from_clf = folder.config()->getProcessor(clf);
  const XYZ white = unit_xyz(kD65);
  for (const Rgb& code : codes()) {
    const Rgb shown = run(processor, code);
    EXPECT_LT(delta_e_2000(xyz_to_lab(linear_xyz(root, code), white), xyz_to_lab(shown, white)), 0.1);
    expect_near(run(from_clf, code), shown, 1e-6);
  }
}

void expect_checked(const WrittenFolder& folder) {
  const std::string command = "ociocheck --iconfig " + (folder.path() / "config.ocio").string() + " > " +
                              (folder.path() / "check.txt").string() + " 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::ifstream file(folder.path() / "check.txt");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("Tests complete."), std::string::npos) << text;
  EXPECT_EQ(text.find("ERROR"), std::string::npos) << text;
}

TEST_F(OcioFolder, PassesOpenColorIosOwnCheck) {
  expect_checked(*folder_);
}

// A single test, because writing the cube of a root polynomial takes long. Checking it takes longer and runs
// nightly.
TEST(OcioFolderOfACube, IsFineEnoughAndPassesOpenColorIosOwnCheck) {
  const WrittenFolder folder(std::array{profile(), profile("blackbody:3200", test::kRootPolynomial)});
  expect_fine_cube(folder);
  if (test::nightly()) expect_checked(folder);
}

// A camera with linear values in a unit, one of whose patches is brighter than the diffuser.
CameraProfile in_unit(double unit) {
  return {fmt::format("unit {}", unit),
          "camera",
          {},
          {1 / (0.6 * unit), 1 / unit, 1 / (0.85 * unit)},
          test::kRootPolynomial,
          {},
          {"R", "G", "B"},
          1.1 * unit};
}

// Digital numbers above black, and electrons per m^2 of a film.
class OcioFolderOfAUnit : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Units, OcioFolderOfAUnit, testing::Values(3500, 2.7e12));

// Expected XYZ of white and of a colour whose products are squares, summed from the terms by hand.
TEST_P(OcioFolderOfAUnit, ShowsTheColoursOfThePolynomial) {
  const CameraProfile camera = in_unit(GetParam());
  const WrittenFolder folder(std::array{camera});
  const auto processor = folder.config()->getProcessor(camera_space(camera).c_str(), kReferenceSpace);
  const double end = std::exp2(std::ceil(std::log2(camera.brightest_patch)));
  const double loss = largest_loss(camera, processor, end);
  EXPECT_GE(folder.written().bake_error, loss);
  EXPECT_LT(folder.written().bake_error, 2 * loss);
  const OCIO::FileTransformRcPtr clf = OCIO::FileTransform::Create();
  clf->setSrc(camera_file(camera, ".clf").c_str());
  const auto from_clf = folder.config()->getProcessor(clf);
  const Raw white = white_values(camera);
  const auto expect_shown = [&](const Rgb& balanced, const Rgb& xyz) {
    const Rgb values{balanced[0] * white[0], balanced[1] * white[1], balanced[2] * white[2]};
    expect_near(run(processor, values), xyz, 1e-3);
    expect_near(run(from_clf, values), xyz, 1e-3);
  };
  expect_shown({1, 1, 1}, {0.95, 1, 1.1});
  expect_shown({0.16, 0.25, 0.09}, {0.1575, 0.232, 0.0915});
}

// Fractions of full scale from an eighth on need no scale, and neither do values after a response curve.
TEST(OcioConfig, CubesEndAboveAllThatWasCalibrated) {
  const auto text = [](const CameraProfile& camera) { return ocio_config_text({&camera, 1}); };
  const std::string to_cube = "- !<ExponentTransform> {value: 0.333333333333333}";
  const std::string next = "\n        ";
  for (const auto& [unit, scale, end] :
       {std::tuple{3500.0, "0.000244140625, 0, 0, 0,", "[0, 4096]"},
        std::tuple{2.7e12, "2.27373675443232e-13, 0, 0, 0,", "[0, 4.39805e+12]"},
        std::tuple{0.05, "16, 0, 0, 0,", "[0, 0.0625]"}}) {
    const std::string config = text(in_unit(unit));
    EXPECT_NE(config.find("children:" + next + "- !<MatrixTransform> {matrix: [" + scale), std::string::npos)
        << config;
    EXPECT_NE(config.find(std::string("Linear values are cut to ") + end), std::string::npos) << config;
  }
  for (const double share : {0.12, 0.5, 0.9})
    EXPECT_NE(text(in_unit(share)).find("children:" + next + to_cube), std::string::npos) << share;
  CameraProfile curved = profile("D65", test::kRootPolynomial);
  curved.brightest_patch = 2;
  EXPECT_NE(text(curved).find("camera_D65.spi1d, interpolation: linear}" + next + to_cube), std::string::npos)
      << text(curved);
}

TEST(OcioConfig, LinearCameraNeedsNoFile) {
  const CameraProfile linear{"D65", "linear", {}, {1, 1, 1}, kMatrix, {}};
  const std::string text = ocio_config_text({&linear, 1});
  EXPECT_EQ(text.find("FileTransform"), std::string::npos);
  EXPECT_NE(text.find("ocio_profile_version: 2"), std::string::npos);
}

TEST(OcioConfig, CallsChannelsByTheirNames) {
  const CameraProfile observer{"D65", "observer", {}, {1.1, 0.9, 1.2}, kMatrix, {}, {"X", "Y", "Z"}};
  const std::string text = ocio_config_text({&observer, 1});
  EXPECT_NE(text.find("has X 0.909091, Y 1.11111, Z 0.833333."), std::string::npos) << text;
}

TEST(OcioConfig, RefusesUnequalCurves) {
  CameraProfile p = profile();
  p.linearisation[1].pop_back();
  test::expect_error(
      [&] {
        static_cast<void>(ocio_config_text({&p, 1}));
      },
      ErrorCode::internal, "one common size");
}

TEST(OcioConfig, RefusesAFileInPlaceOfTheFolder) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("abbe_ocio_file_" + std::to_string(::getpid()));
  std::ofstream(file) << "taken";
  test::expect_error([&] { write_ocio_config(file, {}); }, ErrorCode::output, file.string());
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace abbe

#include "calibration/metrics/camera_quality.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "io/data_directory.h"
#include "tests/calibration/calibration_fixture.h"
#include "tests/tier.h"

namespace abbe {
namespace {

// Numbers in the row of the stored table that begins with `camera`.
std::vector<double> stored(const std::string& camera) {
  std::ifstream file(data_directory().parent_path() / "tests" / "calibration" / "camera_qualities.txt");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(camera + " ")) continue;
    std::istringstream cells(line.substr(camera.size()));
    return {std::istream_iterator<double>(cells), {}};
  }
  return {};
}

// Quality of one camera, computed step by step.
CameraQuality quality_of(const std::string& name) {
  const PatchColors colors = integrate(test::chart(), test::camera(name), test::illuminant("D65"));
  const CorrectionFit matrix = fit_correction(colors);
  CorrectionOptions root;
  root.model = CorrectionModel::root_polynomial_2;
  return {name,
          matrix.start,
          matrix.errors,
          cross_validate(colors, {}, colors.raw.size()),
          fit_correction(colors, root).errors,
          cross_validate(colors, root, colors.raw.size()),
          sensitivity_index(test::camera(name))};
}

// Qualities of all cameras in nightly runs, of two cameras otherwise.
std::vector<CameraQuality> qualities() {
  if (!test::nightly()) return {quality_of("Nikon_D5100"), quality_of("ARRI_D21")};
  std::vector<CameraQuality> all = all_camera_qualities(test::chart(), test::illuminant("D65"));
  EXPECT_EQ(all.size(), 31U);
  return all;
}

TEST(Characterisation, EveryCameraIsAsInTheStoredTable) {
  const auto all = qualities();
  ASSERT_FALSE(all.empty());
  for (const CameraQuality& q : all) {
    EXPECT_LE(q.matrix.mean, q.least_squares.mean) << q.camera;
    EXPECT_LT(q.root.mean, q.matrix.mean) << q.camera;
    const std::vector<double> shown{q.least_squares.mean, q.least_squares.max,  q.matrix.mean,
                                    q.matrix.max,         q.matrix_unseen.mean, q.matrix_unseen.max,
                                    q.root.mean,          q.root.max,           q.root_unseen.mean,
                                    q.root_unseen.max,    q.sensitivity_index};
    const std::vector<double> written = stored(q.camera);
    ASSERT_EQ(written.size(), shown.size()) << q.camera;
    for (std::size_t i = 0; i < shown.size(); ++i)
      EXPECT_NEAR(written[i], shown[i], 0.0051) << q.camera << ", figure " << i;
  }
}

TEST(Characterisation, EveryTableOfReflectancesTrains) {
  for (const auto& [name, patches] : {std::pair{"colorchecker24_ohta1997", 24},
                                      {"colorchecker24_iso17321-1", 24},
                                      {"cie224_ces01-99_5nm", 99},
                                      {"cie224_ces01-99_1nm", 99},
                                      {"rawtoaces_190_patches", 190},
                                      {"pmc_chart_luo2024", 30},
                                      {"cri_tcs01-14", 14}}) {
    const PatchColors colors = integrate(test::chart(name), test::camera(), test::illuminant("D65"));
    EXPECT_EQ(colors.raw.size(), static_cast<std::size_t>(patches)) << name;
    const CorrectionFit fit = fit_correction(colors);
    EXPECT_LT(fit.errors.mean, fit.start.mean) << name;
    EXPECT_LT(fit.errors.mean, 2) << name;
  }
}

TEST(Characterisation, IndexOfAnObserverIsOneHundred) {
  EXPECT_NEAR(sensitivity_index(observer_channels(Observer::cie1931)), 100, 1e-4);
  EXPECT_LT(sensitivity_index(test::camera()), 95);
}

}  // namespace
}  // namespace abbe

#include "calibration/fit/correction.h"

#include <random>

#include <gtest/gtest.h>

#include "calibration/camera_calibration.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

PatchColors integrated() {
  return integrate(test::chart(), test::camera(), test::illuminant("D65"));
}

TEST(NoiseWeights, AreOneWithoutNoiseAndFallWithIt) {
  const PatchColors colors = integrated();
  std::vector<Raw> deviations(colors.raw.size());
  for (const double weight : noise_weights(colors, deviations)) EXPECT_EQ(weight, 1);
  deviations[3] = {0.001, 0.001, 0.001};
  deviations[5] = {0.05, 0.05, 0.05};
  const std::vector<double> weights = noise_weights(colors, deviations);
  EXPECT_EQ(weights[0], 1);
  EXPECT_GT(weights[3], 0.5);
  EXPECT_LT(weights[5], 0.1);
}

TEST(NoiseWeights, LetAFitForgetPatchesThatAreNothingButNoise) {
  // Four patches are ruined. A fit that knows their noise predicts all patches as well as a fit to clean
  // values.
  const PatchColors clean = integrated();
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.2);
  MeasuredCamera camera{"ruined", "D65", {clean}, {}};
  camera.chart.deviations.assign(clean.raw.size(), {1e-4, 1e-4, 1e-4});
  for (const std::size_t i : {1U, 8U, 14U, 17U}) {
    camera.chart.deviations[i] = {0.2, 0.2, 0.2};
    for (double& v : camera.chart.colors.raw[i]) v = std::abs(v + noise(random));
  }
  CharacterisationOptions options;
  options.bootstrap_draws = 2;
  const auto mean_on_clean = [&] {
    return patch_errors(clean, calibrate_measured(camera, options).correction.correction).mean;
  };
  const double weighed = mean_on_clean();
  camera.chart.deviations.clear();
  const double alike = mean_on_clean();
  const double best = fit_correction(clean).errors.mean;
  EXPECT_LT(weighed, best + 0.1);
  EXPECT_GT(alike, weighed + 0.05);
}

TEST(Calibration, IsLinearUnlessAResponseIsPlanted) {
  const CalibrationSetup linear{"Nikon_D5100",           "D65",        "", 12, test::camera(),
                                test::illuminant("D65"), test::chart()};
  CharacterisationOptions options;
  options.folds = 2;
  options.bootstrap_draws = 2;
  const CameraCalibration made = calibrate_camera(linear, options);
  EXPECT_TRUE(made.responses.empty());
  EXPECT_TRUE(made.profile.linearisation[0].empty());
  EXPECT_EQ(made.times_s.size(), 1U);
  EXPECT_NEAR(made.correction.errors.mean, fit_correction(integrated()).errors.mean, 0.03);
}

TEST(Calibration, TrainsOnOtherReflectancesAndJudgesTheChart) {
  CalibrationSetup setup{"Nikon_D5100",
                         "D65",
                         "",
                         12,
                         test::camera(),
                         test::illuminant("D65"),
                         test::chart(),
                         test::chart("rawtoaces_190_patches")};
  CharacterisationOptions options;
  options.bootstrap_draws = 2;
  const CameraCalibration trained = calibrate_camera(setup, options);
  EXPECT_EQ(trained.training_patches, 190U);
  EXPECT_EQ(trained.colors.names.size(), 24U);
  EXPECT_EQ(trained.unseen.delta_e, trained.correction.errors.delta_e) << "no patch of the chart was fitted";
  const double own = fit_correction(integrated()).errors.mean;
  EXPECT_GT(trained.correction.errors.mean, own);
  EXPECT_LT(trained.correction.errors.mean, 2 * own);
}

TEST(Calibration, ChoosesTheModelThatShowsUnseenPatchesBest) {
  CalibrationSetup setup{"Nikon_D5100",           "D65",        "", 12, test::camera(),
                         test::illuminant("D65"), test::chart()};
  CharacterisationOptions options;
  options.choose = true;
  options.bootstrap_draws = 2;
  const CameraCalibration real = calibrate_camera(setup, options);
  ASSERT_EQ(real.candidates.size(), 2U) << "24 patches are too few for 13 terms";
  EXPECT_EQ(real.candidates[0].model, CorrectionModel::root_polynomial_2);
  EXPECT_LT(real.candidates[0].unseen_mean, real.candidates[1].unseen_mean);
  EXPECT_EQ(real.correction.correction.model, CorrectionModel::root_polynomial_2);
  EXPECT_NEAR(real.unseen.mean, real.candidates[0].unseen_mean, 1e-12);
  // For an observer, a matrix is exact.
  setup.channels = observer_channels(Observer::cie1931);
  setup.bits = 0;
  EXPECT_EQ(calibrate_camera(setup, options).correction.correction.model, CorrectionModel::linear);
}

}  // namespace
}  // namespace abbe

#include "calibration/fit/correction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/fit/resampling.h"
#include "spectral/sources.h"
#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

using test::nikon;

void expect_white_kept(const PatchColors& colors, const ColorCorrection& correction) {
  const XYZ white = correction({1, 1, 1});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(white[i], colors.white[i], 1e-14);
}

CorrectionOptions root_polynomial() {
  CorrectionOptions options;
  options.model = CorrectionModel::root_polynomial_2;
  return options;
}

TEST(CorrectionFit, ImprovesOnItsStartAndKeepsTheWhite) {
  for (const char* light : {"A", "D65", "FL11"}) {
    const PatchColors colors = nikon(light);
    const CorrectionFit fit = fit_correction(colors);
    expect_white_kept(colors, white_preserving_least_squares(colors));
    expect_white_kept(colors, fit.correction);
    EXPECT_LT(fit.errors.mean, 0.99 * fit.start.mean) << light;
    EXPECT_LT(fit.final_cost, fit.initial_cost) << light;
    EXPECT_EQ(fit.usable, fit.starts) << light;
    EXPECT_NEAR(fit.errors.mean, patch_errors(colors, fit.correction).mean, 0);
  }
}

TEST(CorrectionFit, IsAMinimumOfTheMeanDifference) {
  const PatchColors colors = nikon("D65");
  const CorrectionFit fit = fit_correction(colors);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j)
      for (const double step : {-0.01, 0.01}) {
        Matrix3 moved = linear_part(fit.correction);
        moved[i][j] += step;
        moved[i][2] -= step;
        EXPECT_GT(patch_errors(colors, linear_correction(moved)).mean, fit.errors.mean + 1e-4);
      }
}

TEST(CorrectionFit, RecoversAPlantedMatrix) {
  PatchColors colors = nikon("D65");
  const Matrix3 planted(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2);
  colors.white = multiply(planted, {1, 1, 1});
  for (std::size_t i = 0; i < colors.raw.size(); ++i) colors.xyz[i] = multiply(planted, colors.raw[i]);
  const CorrectionFit fit = fit_correction(colors);
  EXPECT_LT(fit.errors.max, 1e-6);
  EXPECT_TRUE(linear_part(fit.correction).equalWithAbsError(planted, 1e-8));
}

TEST(CorrectionFit, RecoversAPlantedMatrixDespiteOutliers) {
  PatchColors colors = nikon("D65");
  const Matrix3 planted(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2);
  colors.white = multiply(planted, {1, 1, 1});
  for (std::size_t i = 0; i < colors.raw.size(); ++i) colors.xyz[i] = multiply(planted, colors.raw[i]);
  colors.xyz[4][0] *= 1.2;
  colors.xyz[11][2] *= 1.3;
  const CorrectionFit fit = fit_correction(colors);
  EXPECT_TRUE(linear_part(fit.correction).equalWithAbsError(planted, 5e-3));
  EXPECT_FALSE(linear_part(white_preserving_least_squares(colors)).equalWithAbsError(planted, 5e-3));
}

TEST(CorrectionFit, EachObjectiveIsBestInItsOwnMeasure) {
  const PatchColors colors = nikon("D65");
  CorrectionOptions options;
  const CorrectionFit by_2000 = fit_correction(colors, options);
  options.objective = Objective::delta_e_76;
  const CorrectionFit by_76 = fit_correction(colors, options);
  options.objective = Objective::xyz;
  const CorrectionFit by_xyz = fit_correction(colors, options);
  EXPECT_LT(by_2000.errors.mean, by_76.errors.mean - 0.005);
  EXPECT_LT(by_76.errors.mean_76, by_2000.errors.mean_76 - 0.005);
  EXPECT_EQ(by_xyz.errors.mean, by_xyz.start.mean);
  EXPECT_EQ(by_xyz.starts, 1);
  const Matrix3 m = linear_part(by_xyz.correction);
  const auto squares = [&](const Matrix3& matrix) {
    double sum = 0;
    for (std::size_t i = 0; i < colors.raw.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        sum += std::pow(multiply(matrix, colors.raw[i])[k] - colors.xyz[i][k], 2);
    return sum;
  };
  EXPECT_LT(squares(m), squares(linear_part(by_2000.correction)));
}

// Cases in which CIE 1976 and CIEDE2000 prefer different corrections.
TEST(CorrectionFit, IsJudgedByItsOwnObjective) {
  CorrectionOptions options;
  options.objective = Objective::delta_e_76;
  for (const char* name :
       {"Sigma_SD1_Merrill_NPL_Darrodi2015", "Canon_PowerShot_S90", "Fujifilm_X-T4", "ARRI_D21"})
    for (const char* light : {"A", "FL11", "HP1"}) {
      const CorrectionFit fit =
          fit_correction(integrate(test::chart(), test::camera(name), test::illuminant(light)), options);
      EXPECT_LT(fit.errors.mean_76, fit.start.mean_76) << name << light;
    }
}

TEST(CorrectionFit, RootPolynomialRecoversAPlantedOne) {
  PatchColors colors = nikon("D65");
  const ColorCorrection& planted = test::kRootPolynomial;
  colors.white = planted({1, 1, 1});
  for (std::size_t i = 0; i < colors.raw.size(); ++i) colors.xyz[i] = planted(colors.raw[i]);
  const CorrectionFit fit = fit_correction(colors, root_polynomial());
  EXPECT_LT(fit.errors.max, 1e-4);
  for (std::size_t t = 0; t < 6; ++t)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(fit.correction.columns[t][i], planted.columns[t][i], 1e-5) << t << i;
}

TEST(CorrectionFit, RootPolynomialKeepsWhiteAndCommutesWithExposure) {
  const PatchColors colors = nikon("D65");
  const CorrectionFit fit = fit_correction(colors, root_polynomial());
  expect_white_kept(colors, fit.correction);
  EXPECT_LT(fit.errors.mean, 0.7 * fit_correction(colors).errors.mean);
  for (const Raw& raw : colors.raw) {
    const XYZ bright = fit.correction({8 * raw[0], 8 * raw[1], 8 * raw[2]});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(bright[i], 8 * fit.correction(raw)[i], 1e-13);
  }
  EXPECT_EQ(correction_terms(CorrectionModel::root_polynomial_2, {-0.25, 1, 1}),
            (std::vector<double>{-0.25, 1, 1, 0, 1, 0}));
}

TEST(CorrectionFit, RefusesDegreeThreeOnTwentyFourPatchesForAGoodReason) {
  test::expect_error([] { require_enough_patches(CorrectionModel::root_polynomial_3, 24); }, ErrorCode::usage,
                     "13 terms on 24 patches would follow the patches and not the camera: a matrix would "
                     "predict other patches better (allowed from 52 patches on)");
  EXPECT_NO_THROW(require_enough_patches(CorrectionModel::root_polynomial_3, 52));
  EXPECT_NO_THROW(require_enough_patches(CorrectionModel::root_polynomial_2, 24));
  const PatchColors colors = nikon("D65");
  CorrectionOptions cubic;
  cubic.model = CorrectionModel::root_polynomial_3;
  cubic.starts = 2;
  EXPECT_LT(fit_correction(colors, cubic).errors.mean, fit_correction(colors, root_polynomial()).errors.mean);
  EXPECT_GT(cross_validate(colors, cubic, 24).mean, cross_validate(colors, {}, 24).mean);
}

// Adjacent bands: without one of the greys, their fit needs more than 300 iterations.
TEST(CorrectionFit, ReachesItsToleranceOnIdealFilters) {
  PatchColors colors = integrate(
      test::chart(),
      std::vector<Channel>{energy_channel("R", band(599.5, 699.5)), energy_channel("G", band(499.5, 599.5)),
                           energy_channel("B", band(399.5, 499.5))},
      test::illuminant("D65"));
  EXPECT_EQ(fit_correction(colors).usable, 16);
  EXPECT_LT(cross_validate(colors, {}, 24).mean, 3.7);
}

TEST(CorrectionFit, SaysWhenItFails) {
  PatchColors colors = nikon("D65");
  CorrectionOptions once;
  once.max_iterations = 1;
  test::expect_error(
      [&] { static_cast<void>(fit_correction(colors, once)); }, ErrorCode::input,
      "colour correction: no correction can be found for these 24 patches: their values do not match");
  for (Raw& raw : colors.raw) raw[1] = raw[0];
  test::expect_error([&] { static_cast<void>(least_squares_matrix(colors)); }, ErrorCode::input,
                     "these 24 patches do not determine the correction: they show 2 independent colours "
                     "(needed 3)");
  test::expect_error([&] { static_cast<void>(fit_correction(colors)); }, ErrorCode::input,
                     "they show 1 independent colours (needed 2)");
}

// One filter at exposures of 0.01, 0.1 and 1: the balanced values differ in their last digits only.
TEST(CorrectionFit, RoundingIsNoColour) {
  std::vector<Channel> bracket;
  for (const double ratio : {0.01, 0.1, 1.0})
    bracket.push_back(exposed(energy_channel("C", band(500, 600)), ratio));
  const PatchColors colors = integrate(test::chart(), bracket, test::illuminant("D65"));
  for (const CorrectionModel model : {CorrectionModel::linear, CorrectionModel::root_polynomial_2})
    test::expect_error([&] { static_cast<void>(white_preserving_least_squares(colors, model)); },
                       ErrorCode::input, "they show 0 independent colours (needed 2)");
  test::expect_error([&] { static_cast<void>(least_squares_matrix(colors)); }, ErrorCode::input,
                     "they show 1 independent colours (needed 3)");
}

// Channels that differ by a fraction of 1e-4, about as much as bands of 10 nm at a distance of 1 nm.
TEST(CorrectionFit, NearlyGreyChannelsHaveColours) {
  PatchColors colors = nikon("D65");
  const Matrix3 planted(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2);
  colors.white = multiply(planted, {1, 1, 1});
  constexpr double kShare = 1e-4;  // fraction of the colour that remains
  for (std::size_t i = 0; i < colors.raw.size(); ++i) {
    colors.xyz[i] = multiply(planted, colors.raw[i]);
    for (const std::size_t k : {0U, 2U})
      colors.raw[i][k] = colors.raw[i][1] + kShare * (colors.raw[i][k] - colors.raw[i][1]);
  }
  const ColorCorrection found = white_preserving_least_squares(colors);
  for (std::size_t i = 0; i < colors.raw.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found(colors.raw[i])[k], colors.xyz[i][k], 1e-9) << i;
}

}  // namespace
}  // namespace abbe

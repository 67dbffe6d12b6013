#include "calibration/fit/matrix.h"

#include <gtest/gtest.h>

#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

PatchColors nikon(const std::string& light) {
  return integrate(test::chart(), test::camera(), test::illuminant(light));
}

void expect_white_kept(const PatchColors& colors, const Matrix3& m) {
  const XYZ white = multiply(m, {1, 1, 1});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(white[i], colors.white[i], 4e-16);
}

TEST(MatrixFit, ImprovesOnItsStartAndKeepsTheWhite) {
  for (const char* light : {"A", "D65", "FL11"}) {
    const PatchColors colors = nikon(light);
    const MatrixFit fit = fit_matrix(colors);
    expect_white_kept(colors, white_preserving_least_squares(colors));
    expect_white_kept(colors, fit.raw_to_xyz);
    EXPECT_LT(fit.errors.mean, 0.99 * fit.start.mean) << light;
    EXPECT_LT(fit.final_cost, fit.initial_cost) << light;
    EXPECT_EQ(fit.usable, fit.starts) << light;
    EXPECT_NEAR(fit.errors.mean, patch_errors(colors, fit.raw_to_xyz).mean, 0);
  }
}

TEST(MatrixFit, IsAMinimumOfTheMeanDifference) {
  const PatchColors colors = nikon("D65");
  const MatrixFit fit = fit_matrix(colors);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j)
      for (const double step : {-0.01, 0.01}) {
        Matrix3 moved = fit.raw_to_xyz;
        moved[i][j] += step;
        moved[i][2] -= step;
        EXPECT_GT(patch_errors(colors, moved).mean, fit.errors.mean + 1e-4);
      }
}

TEST(MatrixFit, RecoversAPlantedMatrix) {
  PatchColors colors = nikon("D65");
  const Matrix3 planted(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2);
  colors.white = multiply(planted, {1, 1, 1});
  for (std::size_t i = 0; i < colors.raw.size(); ++i) colors.xyz[i] = multiply(planted, colors.raw[i]);
  const MatrixFit fit = fit_matrix(colors);
  EXPECT_LT(fit.errors.max, 1e-6);
  EXPECT_TRUE(fit.raw_to_xyz.equalWithAbsError(planted, 1e-8));
}

TEST(MatrixFit, RecoversAPlantedMatrixDespiteOutliers) {
  PatchColors colors = nikon("D65");
  const Matrix3 planted(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2);
  colors.white = multiply(planted, {1, 1, 1});
  for (std::size_t i = 0; i < colors.raw.size(); ++i) colors.xyz[i] = multiply(planted, colors.raw[i]);
  colors.xyz[4][0] *= 1.2;
  colors.xyz[11][2] *= 1.3;
  const MatrixFit fit = fit_matrix(colors);
  EXPECT_TRUE(fit.raw_to_xyz.equalWithAbsError(planted, 5e-3));
  EXPECT_FALSE(white_preserving_least_squares(colors).equalWithAbsError(planted, 5e-3));
}

TEST(MatrixFit, SaysWhenItFails) {
  PatchColors colors = nikon("D65");
  test::expect_error([&] { static_cast<void>(fit_matrix(colors, {.max_iterations = 1})); }, ErrorCode::input,
                     "matrix fit: no start converged");
  for (Raw& raw : colors.raw) raw[1] = raw[0];
  test::expect_error([&] { static_cast<void>(least_squares_matrix(colors)); }, ErrorCode::input,
                     "24 patches do not determine the matrix (rank 2, needed 3)");
  test::expect_error([&] { static_cast<void>(fit_matrix(colors)); }, ErrorCode::input, "(rank 1, needed 2)");
}

}  // namespace
}  // namespace abbe

#include "calibration/fit/resampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

using test::nikon;

TEST(CrossValidation, ShowsEachPatchByAFitWithoutIt) {
  PatchColors colors = nikon("D65");
  const PatchErrors before = cross_validate(colors, {}, 24);
  const double seen = fit_correction(colors).errors.delta_e[17];
  EXPECT_GT(before.delta_e[17], seen);
  // The colour of a patch changes its own error, but not the fit that predicts it.
  colors.xyz[17] = fit_correction(colors).correction(colors.raw[17]);
  PatchColors without = nikon("D65");
  without.names.erase(without.names.begin() + 17);
  without.raw.erase(without.raw.begin() + 17);
  without.xyz.erase(without.xyz.begin() + 17);
  PatchColors alone{{"cyan"}, {colors.raw[17]}, {colors.xyz[17]}, colors.white};
  const double expected = patch_errors(alone, fit_correction(without).correction).delta_e[0];
  EXPECT_NEAR(cross_validate(colors, {}, 24).delta_e[17], expected, 1e-4);
}

TEST(CrossValidation, DealsPatchesToFolds) {
  const PatchColors colors = nikon("D65");
  const PatchErrors errors = cross_validate(colors, {}, 5);
  double mean = 0;
  double largest = 0;
  for (const double e : errors.delta_e) {
    mean += e / 24;
    largest = std::max(largest, e);
  }
  EXPECT_EQ(errors.delta_e.size(), 24U);
  EXPECT_NEAR(errors.mean, mean, 1e-12);
  EXPECT_EQ(errors.max, largest);
  for (const std::size_t folds : {0U, 1U, 25U})
    test::expect_error([&] { static_cast<void>(cross_validate(colors, {}, folds)); }, ErrorCode::usage,
                       "allowed 2 to the 24 patches");
}

// The standard error of a mean is known in closed form.
TEST(Bootstrap, IntervalOfAMeanIsTwoStandardErrorsWide) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(3, 2);
  std::vector<double> values(400);
  for (double& v : values) v = normal(random);
  double mean = 0;
  for (const double v : values) mean += v / 400;
  const Interval interval = bootstrap_mean(values, 4000);
  EXPECT_NEAR(interval.low, mean - 1.96 * 0.1, 0.02);
  EXPECT_NEAR(interval.high, mean + 1.96 * 0.1, 0.02);
  EXPECT_EQ(bootstrap_mean(values, 4000).low, interval.low);
}

TEST(Bootstrap, ColumnsOfAnExactCorrectionHaveNoSpread) {
  PatchColors colors = nikon("D65");
  const Matrix3 planted(0.6, 0.25, 0.1, 0.2, 0.95, -0.15, 0.05, -0.2, 1.2);
  colors.white = multiply(planted, {1, 1, 1});
  for (std::size_t i = 0; i < colors.raw.size(); ++i) colors.xyz[i] = multiply(planted, colors.raw[i]);
  const auto columns = bootstrap_columns(colors, {}, 20);
  ASSERT_EQ(columns.size(), 3U);
  for (int t = 0; t < 3; ++t)
    for (int i = 0; i < 3; ++i) {
      const Interval& interval = columns[static_cast<std::size_t>(t)][static_cast<std::size_t>(i)];
      EXPECT_NEAR(interval.low, planted[i][t], 1e-5);
      EXPECT_NEAR(interval.high, planted[i][t], 1e-5);
    }
  const auto real = bootstrap_columns(nikon("D65"), {}, 20);
  EXPECT_GT(real[0][0].high, real[0][0].low + 0.01);
}

}  // namespace
}  // namespace abbe

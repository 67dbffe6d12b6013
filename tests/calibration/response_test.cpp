#include "calibration/fit/response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

std::vector<double> stops(double low, double high, double step) {
  std::vector<double> times;
  for (int i = 0; low + i * step <= high; ++i) times.push_back(std::exp2(low + i * step));
  return times;
}

// The chart's green values through a measured camera.
std::vector<double> chart_values() {
  std::vector<double> values;
  const Curve light = test::illuminant("D65");
  const std::vector<Channel> camera = test::camera();
  for (const Patch& patch : test::chart().patches)
    values.push_back(camera_raw(camera, light, patch.reflectance)[1]);
  return values;
}

// Largest error between 1 % and 99 % of the code range, as a share of full scale.
double worst_error(const ResponseFit& fit, const PlantedResponse& planted) {
  double worst = 0;
  for (int i = 10; i <= 990; ++i)
    worst = std::max(worst, std::abs(linearise(fit.linear, i / 1000.0) - planted.exposure(i / 1000.0)));
  return worst;
}

TEST(PlantedResponse, InvertsItself) {
  for (const char* name : {"linear", "gamma:2.2", "s-curve"}) {
    const PlantedResponse response(name);
    EXPECT_NEAR(response.code(0), 0, 1e-15);
    EXPECT_NEAR(response.code(1), 1, 1e-15);
    EXPECT_EQ(response.code(3), 1);
    for (double x = 0.01; x < 1; x += 0.01)
      EXPECT_NEAR(response.exposure(response.code(x)), x, 1e-12) << name;
  }
  EXPECT_NEAR(PlantedResponse("gamma:2.2").code(0.18), std::pow(0.18, 1 / 2.2), 1e-15);
  EXPECT_NEAR(PlantedResponse("s-curve").code(0.18), 0.5 * (1 + std::pow(0.18, 1.4)), 1e-15);
}

TEST(PlantedResponse, RefusesOtherNames) {
  for (const char* name : {"", "gamma:", "gamma:0", "gamma:2.2x", "log"})
    test::expect_error([&] { static_cast<void>(PlantedResponse(name)); }, ErrorCode::usage,
                       "expected linear, s-curve or gamma:G");
}

TEST(ExposureSeries, RoundsToCodes) {
  const ExposureSeries series =
      expose(std::array{0.5, 2.0}, std::array{0.25, 1.0}, PlantedResponse("linear"), 8);
  EXPECT_EQ(series.codes[0][0], 32.0 / 255);
  EXPECT_EQ(series.codes[0][1], 128.0 / 255);
  EXPECT_EQ(series.codes[1][1], 1);
}

TEST(ResponseFit, RecoversPlantedCurves) {
  for (const char* name : {"linear", "gamma:2.2", "gamma:1.8", "s-curve"}) {
    const PlantedResponse planted(name);
    for (const auto& [bits, margin] : {std::pair{0, 0.001}, {14, 0.001}, {12, 0.001}, {10, 0.003}}) {
      const ResponseFit fit = recover_response(expose(chart_values(), stops(-9, 6, 1.0 / 3), planted, bits));
      EXPECT_LT(worst_error(fit, planted), margin) << name << ", " << bits << " bits";
      EXPECT_EQ(fit.linear.size(), 4096U);
      EXPECT_EQ(fit.linear.front(), 0);
      EXPECT_EQ(fit.linear.back(), 1);
      EXPECT_TRUE(std::is_sorted(fit.linear.begin(), fit.linear.end(), std::less_equal<>())) << name;
    }
  }
}

TEST(ResponseFit, RecoversTheToeInRelativeTermsToo) {
  const PlantedResponse planted("gamma:2.2");
  const ResponseFit fit = recover_response(expose(chart_values(), stops(-9, 6, 1.0 / 3), planted, 14));
  for (double code = 0.05; code < 1; code += 0.01)
    EXPECT_NEAR(linearise(fit.linear, code) / planted.exposure(code), 1, 0.005) << code;
}

TEST(ResponseFit, DoesNotDependOnTheUnknownBrightness) {
  std::vector<double> values = chart_values();
  const std::vector<double> times = stops(-8, 5, 0.5);
  std::vector<double> shorter = times;
  for (double& v : values) v *= 8;
  for (double& t : shorter) t /= 8;
  const PlantedResponse planted("s-curve");
  const ResponseFit bright = recover_response(expose(values, shorter, planted, 12), 1024);
  const ResponseFit plain = recover_response(expose(chart_values(), times, planted, 12), 1024);
  for (std::size_t i = 0; i < 1024; ++i) EXPECT_NEAR(bright.linear[i], plain.linear[i], 1e-6);
}

TEST(ResponseFit, SurvivesOutliers) {
  for (const char* name : {"gamma:2.2", "s-curve"}) {
    const PlantedResponse planted(name);
    ExposureSeries series = expose(chart_values(), stops(-8, 6, 0.5), planted, 12);
    std::mt19937 random(3);
    for (std::vector<double>& codes : series.codes)
      for (double& code : codes)
        if (random() % 20 == 0) code = std::min(1.0, code + 0.1);
    EXPECT_LT(worst_error(recover_response(series), planted), 0.002) << name;
  }
}

TEST(ResponseFit, SaysWhatIsMissing) {
  const PlantedResponse linear("linear");
  const std::vector<double> values = chart_values();
  const auto fit = [&](const std::vector<double>& times) {
    return [&, times] { static_cast<void>(recover_response(expose(values, times, linear, 12))); };
  };
  test::expect_error(fit({1}), ErrorCode::input, "an exposure series needs two times or more (got 1)");
  test::expect_error(fit({1, 0}), ErrorCode::input, "exposure times must be positive");
  test::expect_error(fit({1e4, 2e4}), ErrorCode::input, "only 0 code values are neither black nor clipped");
}

}  // namespace
}  // namespace abbe

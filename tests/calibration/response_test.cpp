#include "calibration/fit/response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/calibration/response_fixture.h"
#include "tests/tier.h"

namespace abbe::test {
namespace {

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
    expect_error([&] { static_cast<void>(PlantedResponse(name)); }, ErrorCode::usage,
                 "expected linear, s-curve or gamma:G");
}

TEST(ExposureSeries, RoundsToCodes) {
  const ExposureSeries series =
      expose(std::array{0.5, 2.0}, std::array{0.25, 1.0}, PlantedResponse("linear"), {8, 0, 0});
  EXPECT_EQ(series.codes[0][0], 32.0 / 255);
  EXPECT_EQ(series.codes[0][1], 128.0 / 255);
  EXPECT_EQ(series.codes[1][1], 1);
}

TEST(ResponseFit, RecoversPlantedCurves) {
  for (const char* name : {"linear", "gamma:2.2", "gamma:1.8", "s-curve"}) {
    const PlantedResponse planted(name);
    for (const auto& [bits, margin] : {std::pair{0, 0.001}, {14, 0.001}, {12, 0.001}, {10, 0.003}}) {
      const ResponseFit fit =
          recover_response(expose(chart_values(), stops(-9, 6, 1.0 / 3), planted, {bits, 0, 0}));
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
  const ResponseFit fit =
      recover_response(expose(chart_values(), stops(-9, 6, 1.0 / 3), planted, {14, 0, 0}));
  for (double code = 0.05; code < 1; code += 0.01)
    EXPECT_NEAR(linearise(fit.linear, code) / planted.exposure(code), 1, 0.005) << code;
}

TEST(ResponseFit, DeviationsFollowTheSlopeOfTheCurve) {
  std::vector<double> square;
  for (int i = 0; i <= 1000; ++i) square.push_back(i / 1000.0 * (i / 1000.0));
  for (const double code : {0.1, 0.5, 0.9})
    EXPECT_NEAR(linearise_deviation(square, code, 1e-3), 2 * code * 1e-3, 1e-12) << code;
  EXPECT_NEAR(linearise_deviation(square, 1, 0.01), 1.99 * 0.01, 1e-12) << "within the codes";
  EXPECT_EQ(linearise_deviation(square, 0.5, 0), 0);
}

TEST(ResponseFit, DoesNotDependOnTheUnknownBrightness) {
  std::vector<double> values = chart_values();
  const std::vector<double> times = stops(-8, 5, 0.5);
  std::vector<double> shorter = times;
  for (double& v : values) v *= 8;
  for (double& t : shorter) t /= 8;
  const PlantedResponse planted("s-curve");
  const ResponseFit bright = recover_response(expose(values, shorter, planted, {12, 0, 0}));
  const ResponseFit plain = recover_response(expose(chart_values(), times, planted, {12, 0, 0}));
  for (std::size_t i = 0; i < plain.linear.size(); ++i) EXPECT_NEAR(bright.linear[i], plain.linear[i], 1e-6);
}

TEST(ResponseFit, SurvivesOutliers) {
  for (const char* name : {"gamma:2.2", "s-curve"}) {
    const PlantedResponse planted(name);
    ExposureSeries series = expose(chart_values(), stops(-8, 6, 0.5), planted, {12, 0, 0});
    std::mt19937 random(3);
    for (std::vector<double>& codes : series.codes)
      for (double& code : codes)
        if (random() % 20 == 0) code = std::min(1.0, code + 0.1);
    const ResponseFit fit = recover_response(series);
    EXPECT_LT(worst_error(fit, planted), 0.002) << name;
    EXPECT_FALSE(fit.misfit) << name;
  }
}

TEST(ExposureSeries, ScattersAsItSays) {
  const CodeNoise noise{12, 1e-3, 4e-6};
  const std::vector<double> values(4000, 0.25);
  const ExposureSeries series = expose(values, std::array{1.0}, PlantedResponse("linear"), noise, 9);
  double sum = 0;
  double squares = 0;
  for (const std::vector<double>& codes : series.codes) {
    sum += codes[0] / 4000;
    squares += (codes[0] - 0.25) * (codes[0] - 0.25) / 4000;
  }
  const double expected = std::sqrt(1e-6 + 4e-6 * 0.25 + std::pow(1 / 4095.0, 2) / 12);
  EXPECT_NEAR(series.deviations[0][0], expected, 1e-5);
  EXPECT_NEAR(std::sqrt(squares), expected, 0.04 * expected);
  EXPECT_NEAR(sum, 0.25, 4 * expected / std::sqrt(4000));
  EXPECT_NE(expose(values, std::array{1.0}, PlantedResponse("linear"), noise, 10).codes[0], series.codes[0]);
  EXPECT_TRUE(expose(values, std::array{1.0}, PlantedResponse("linear"), {}).deviations.empty());
}

TEST(ResponseFit, ItsIntervalHoldsThePlantedCurve) {
  for (const char* name : {"linear", "gamma:2.2", "s-curve"}) {
    const Recovery recovery = recover_often(name, by_night(6, 3));
    EXPECT_LT(recovery.worst, 0.003) << name;
    EXPECT_GE(recovery.coverage, 0.85) << name;
    EXPECT_LE(recovery.coverage, 1) << name;
  }
}

// Photon noise makes the errors of bright codes many times those of dark ones, and the series does not state
// it.
TEST(ResponseFit, ItsIntervalHoldsThePlantedCurveOfSinglePixels) {
  for (const char* name : {"linear", "gamma:2.2", "s-curve"})
    EXPECT_GE(recover_often(name, by_night(6, 3), kSinglePixels, false).coverage, 0.85) << name;
}

// Ten times the noise widens the interval ten times, whether the series states it or not.
TEST(ResponseFit, IntervalGrowsWithTheNoise) {
  const PlantedResponse planted("gamma:2.2");
  const auto width = [&](double read, double stated) {
    ExposureSeries series = expose(chart_values(), stops(-9, 6, 1.0 / 3), planted, {0, read, 0}, 4);
    for (std::vector<double>& deviations : series.deviations)
      for (double& d : deviations) d *= stated;
    const ResponseFit fit = recover_response(series);
    EXPECT_NEAR(fit.noise_scale * stated, 1, 0.15);
    return linearise(fit.log_deviation, 0.2);
  };
  const double narrow = width(1e-4, 1);
  EXPECT_NEAR(width(1e-3, 1) / narrow, 10, 4);
  EXPECT_NEAR(width(1e-4, 5) / narrow, 1, 0.05);
}

// Saturated patches that noise moves below full scale would bend the curve there.
TEST(ResponseFit, ClippingByNoiseDoesNotPullTheCurve) {
  for (const char* name : {"linear", "s-curve"}) {
    const PlantedResponse planted(name);
    const ExposureSeries series = expose(chart_values(), stops(-9, 6, 1.0 / 6), planted, {12, 1e-3, 0}, 3);
    const ResponseFit fit = recover_response(series);
    EXPECT_LT(worst_error(fit, planted), 0.005) << name;
    EXPECT_GT(coverage(fit, planted), 0.7) << name;
    ExposureSeries unknown = series;
    unknown.deviations.clear();
    EXPECT_LT(worst_error(recover_response(unknown), planted), 0.01) << name;
  }
}

// Codes grow a quarter as fast from 0.8 on. 24 patches and six times in ratios of two give few codes above
// the knee.
TEST(ResponseFit, AKneeThatTheCurveDoesNotFollowIsReported) {
  constexpr double kKnee = 0.8;
  const auto code_of = [](double x) { return x < kKnee ? x : std::min(1.0, kKnee + (x - kKnee) / 4); };
  const auto exposure_of = [](double z) { return z < kKnee ? z : kKnee + 4 * (z - kKnee); };
  ExposureSeries series{stops(-4, 1, 1), {}, {}};
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 24; ++i) {
    std::vector<double>& codes = series.codes.emplace_back();
    std::vector<double>& deviations = series.deviations.emplace_back();
    for (const double time : series.times_s) {
      const double code = code_of(0.0026 * std::exp(0.277 * i) * time);
      deviations.push_back(std::hypot(3e-5, 1.5e-4 * std::sqrt(code)));
      codes.push_back(code < 1 ? std::clamp(code + deviations.back() * normal(random), 0.0, 1.0) : 1);
    }
  }
  const ResponseFit fit = recover_response(series);
  ASSERT_TRUE(fit.misfit);
  EXPECT_GT(fit.misfit->exposure, 0.005);
  EXPECT_LT(fit.misfit->low_code, kKnee);
  EXPECT_EQ(fit.misfit->high_code, 1) << "the last codes are among them";
  int inside = 0;
  for (int i = 10; i <= 990; ++i) {
    const double code = i / 1000.0;
    const double ratio =
        linearise(fit.linear, code) / linearise(fit.linear, 0.5) * exposure_of(0.5) / exposure_of(code);
    inside += std::abs(std::log(ratio)) <= 1.96 * linearise(fit.log_deviation, code) ? 1 : 0;
  }
  EXPECT_GT(inside, 0.75 * 981)
      << "the interval includes the misfit, without which it holds half of the codes";
  for (const char* smooth : {"linear", "gamma:2.2", "s-curve"})
    EXPECT_FALSE(
        recover_response(expose(chart_values(), stops(-9, 6, 1.0 / 3), PlantedResponse(smooth), kNoisyCamera))
            .misfit)
        << smooth;
}

TEST(ResponseFit, AFitThatDoesNotConvergeIsAnError) {
  const ExposureSeries series =
      expose(chart_values(), stops(-9, 6, 1.0 / 3), PlantedResponse("s-curve"), {12, 0, 0});
  expect_error([&] { static_cast<void>(recover_response(series, 2)); }, ErrorCode::input,
               "response fit: no curve fits these codes (gave up after");
}

TEST(ResponseFit, SaysWhatIsMissing) {
  const PlantedResponse linear("linear");
  const std::vector<double> values = chart_values();
  const auto fit = [&](const std::vector<double>& times) {
    return [&, times] { static_cast<void>(recover_response(expose(values, times, linear, {12, 0, 0}))); };
  };
  expect_error(fit({1}), ErrorCode::input, "an exposure series needs two times or more (got 1)");
  expect_error(fit({1, 0}), ErrorCode::input, "exposure times must be positive");
  expect_error(fit({1e4, 2e4}), ErrorCode::input, "only 0 code values are neither black nor clipped");
  expect_error(
      fit({0.5, 0.50005}), ErrorCode::input,
      "the exposure times do not determine the curve: the longest is 1.0001 times the shortest (allowed from "
      "1.02 on");
}

// Two nearly equal exposures. Many patches of little noise determine the curve at their codes but not above.
// Few patches of much noise determine neither.
TEST(ResponseFit, RefusesACurveThatItDoesNotKnow) {
  const auto series = [](int patches, double seconds, double noise) {
    std::vector<double> values;
    for (int i = 0; i < patches; ++i) values.push_back(std::exp(-2.5 * i / patches));
    return expose(values, std::array{seconds, 1.02 * seconds}, PlantedResponse("linear"), {12, noise, 0});
  };
  expect_error([&] { static_cast<void>(recover_response(series(192, 0.5, 5e-4))); }, ErrorCode::input,
               "no exposure determines the curve above code 0.51");
  ExposureSeries few = series(40, 0.7, 3e-3);
  few.deviations.clear();
  expect_error([&] { static_cast<void>(recover_response(few)); }, ErrorCode::input,
               "these exposures do not determine the curve: of the codes");
}

TEST(ResponseFit, NoticesExposureTimesThatAreSwapped) {
  for (const auto& [first, second] : {std::pair{10U, 11U}, {8U, 20U}}) {
    ExposureSeries series =
        expose(chart_values(), stops(-9, 6, 1.0 / 3), PlantedResponse("gamma:2.2"), kSinglePixels);
    std::swap(series.times_s[first], series.times_s[second]);
    expect_error([&] { static_cast<void>(recover_response(series)); }, ErrorCode::input,
                 "are exposure times swapped, or did the light change?");
  }
}

}  // namespace
}  // namespace abbe::test

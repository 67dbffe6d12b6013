#include "sensor/readout/photon_transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "sensor/readout/readout.h"

namespace abbe {
namespace {

// Relative deviations d from the line y = t at t = 1, 2, 3, 6 for which it remains the best line. With u =
// d/(1 + d)^2, the sums of u and of u/t are both 0.
std::vector<TransferPoint> around_a_line(double u, double scale = 1) {
  std::vector<TransferPoint> points;
  for (const auto& [t, part] : {std::pair{1.0, u}, {2.0, -4 * u}, {3.0, 3 * u}, {6.0, 0.0}}) {
    const double d = part == 0 ? 0 : (1 - 2 * part - std::sqrt(1 - 4 * part)) / (2 * part);
    points.push_back({t, scale * t * (1 + d), 1, 1});
  }
  return points;
}

TEST(Linearity, TheErrorIsTheMeanRelativeDeviationFromTheBestLine) {
  double sum = 0;
  for (const TransferPoint& p : around_a_line(0.002)) sum += std::abs(p.signal_dn / p.exposure_s - 1);
  EXPECT_NEAR(sum, 0.016, 2e-4);
  EXPECT_NEAR(linearity_error_percent(around_a_line(0.002), 10).value(), 100 * sum / 4, 1e-9);
  EXPECT_NEAR(linearity_error_percent(around_a_line(0.002, 100), 1000).value(), 100 * sum / 4, 1e-9);
  EXPECT_NEAR(linearity_error_percent(around_a_line(0), 10).value(), 0, 1e-12);
}

TEST(Linearity, CountsSignalsBetweenTheEndsAloneUnderOneLight) {
  std::vector<TransferPoint> points = around_a_line(0.002);
  const double error = linearity_error_percent(points, 10).value();
  points.push_back({8, 9.8, 1, 1});     // above 95 % of saturation
  points.push_back({0.3, 0.45, 1, 1});  // below 5 %
  EXPECT_NEAR(linearity_error_percent(points, 10).value(), error, 1e-12);
  points.resize(3);
  EXPECT_FALSE(linearity_error_percent(points, 10)) << "three times";
  points = around_a_line(0);
  points[1].signal_dn = 5;
  EXPECT_FALSE(linearity_error_percent(points, 10)) << "another light";
}

// y = l + b l^2 for light l, with the variance of photons scaled by its slope, for a gain of 2.
std::vector<TransferPoint> parabola(double b) {
  std::vector<TransferPoint> points;
  for (const double l : {100.0, 200.0, 400.0, 600.0, 700.0}) {
    const double slope = 1 + 2 * b * l;
    const double variance = slope * slope * l / 2;
    points.push_back({l / 1000, l + b * l * l, variance, variance * variance * 1e-6});
  }
  return points;
}

TEST(Linearity, TheBiasOfTheGainIsThatOfItsFit) {
  for (const double b : {-2e-5, -1e-6, 3e-5}) {
    const std::vector<TransferPoint> points = parabola(b);
    double squares = 0;
    double products = 0;
    for (const TransferPoint& p : points) {
      squares += p.signal_dn * p.signal_dn;
      products += p.signal_dn * p.variance_dn2;
    }
    const double bias = squares / products / 2 - 1;
    const RelativeBias by_times = gain_bias(points, true).value();
    EXPECT_NEAR(by_times.value, bias, 1e-9) << b;
    EXPECT_LT(by_times.standard_error, 1e-9) << b;
    const RelativeBias by_variances = gain_bias(points, false).value();
    EXPECT_NEAR(by_variances.value, bias, 0.05 * std::abs(bias)) << b;
    EXPECT_NEAR(by_variances.standard_error, 1e-3, 7e-4) << b;
  }
  EXPECT_FALSE(gain_bias(std::vector<TransferPoint>(5, parabola(0)[0]), false)) << "one signal";
}

// Codes of a parabola that is 2 % steeper in weak light, which no file declares. Response curves are linear
// between their points, and all exposures lie on points, so their means are those of the parabola. Expected
// values are those of the parabola without noise. The gain is fitted to the four exposures up to 0.4; LE uses
// the six up to 0.6.
TEST(Linearity, AResponseTwoPercentOffBiasesTheGainAsReported) {
  constexpr double kBend = 0.02;
  Readout readout;
  readout.gain_e_per_dn = 4;
  readout.bits = 14;
  readout.offset_dn = 100;
  readout.read_noise_e = 8;
  std::vector<MonotoneCurve::Point> curve;
  for (int i = 0; i <= 20; ++i) {
    const double x = i / 20.0;
    curve.push_back({x, x * (1 + kBend * (1 - x))});
  }
  readout.response_curve = MonotoneCurve(curve);
  const double most_e = electrons_of(readout, readout.highest_code());
  std::deque<RawFrame> frames;
  const auto pair = [&](double electrons, double exposure_s) {
    const std::vector<float> expected(160000, static_cast<float>(electrons));
    for (int i = 0; i < 2; ++i)
      frames.push_back(
          read_out(readout, expected, {exposure_s, 20, static_cast<std::uint32_t>(frames.size())}));
    return FlatPair{exposure_s, frames[frames.size() - 2].dn, frames.back().dn};
  };
  const std::vector<FlatPair> dark{pair(0, 0.1), pair(0, 1)};
  std::vector<FlatPair> lit;
  for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 1.6})
    lit.push_back(pair(share * most_e, share));
  const PhotonTransfer found = photon_transfer(dark, lit, readout.bits);
  const double weak_gain = readout.gain_e_per_dn / (1 + kBend);
  EXPECT_NEAR(found.gain_bias.value().value, 0.01994, 0.001);
  EXPECT_NEAR(found.gain_e_per_dn / (1 + found.gain_bias->value), weak_gain, 0.01 * weak_gain);
  EXPECT_NEAR(found.linearity_error_percent.value(), 0.1478, 0.01);
}

}  // namespace
}  // namespace abbe

#include "calibration/metrics/slanted_edge.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/calibration/calibration_fixture.h"

namespace abbe {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 96;

// An edge at this angle to the columns, blurred by a Gaussian of this deviation [pixels] and by the pixels.
// Their means are taken over 16 x 16 points.
std::vector<double> edge(double angle_deg, double deviation, double dark = 0.1, double bright = 0.9) {
  const double angle = angle_deg * std::numbers::pi / 180;
  const auto at = [&](double x, double y) {
    const double distance = (x - kWidth / 2.0) * std::cos(angle) - (y - kHeight / 2.0) * std::sin(angle);
    return dark + (bright - dark) * 0.5 * std::erfc(-distance / deviation / std::sqrt(2.0));
  };
  constexpr int kPoints = 16;
  std::vector<double> values;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      double sum = 0;
      for (int i = 0; i < kPoints; ++i)
        for (int j = 0; j < kPoints; ++j) sum += at(x + (i + 0.5) / kPoints, y + (j + 0.5) / kPoints);
      values.push_back(sum / kPoints / kPoints);
    }
  return values;
}

// Modulation of the Gaussian and of the pixel's square, across the edge.
double expected(double frequency, double angle_deg, double deviation) {
  const double angle = angle_deg * std::numbers::pi / 180;
  const auto sinc = [](double x) {
    return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
  };
  const double blur = std::numbers::pi * frequency * deviation;
  return std::exp(-2 * blur * blur) * sinc(frequency * std::cos(angle)) * sinc(frequency * std::sin(angle));
}

TEST(SlantedEdge, FindsTheModulationOfPixelsAndBlur) {
  for (const double angle : {5.0, -5.0, 12.0})
    for (const double deviation : {0.3, 0.8}) {
      const EdgeResponse found = slanted_edge(edge(angle, deviation), kWidth, kHeight);
      EXPECT_NEAR(std::abs(found.angle_deg), std::abs(angle), 0.02);
      EXPECT_FALSE(found.is_horizontal);
      for (std::size_t i = 0; i < found.mtf.size() && found.frequency(i) <= 0.5; ++i)
        EXPECT_NEAR(found.mtf[i], expected(found.frequency(i), angle, deviation), 0.01)
            << angle << ' ' << deviation << ' ' << found.frequency(i);
    }
}

TEST(SlantedEdge, DoesNotDependOnDirectionOrExposure) {
  const std::vector<double> upright = edge(5, 0.5);
  std::vector<double> turned;
  for (int x = 0; x < kWidth; ++x)
    for (int y = 0; y < kHeight; ++y) turned.push_back(upright[static_cast<std::size_t>(y * kWidth + x)]);
  const EdgeResponse a = slanted_edge(upright, kWidth, kHeight);
  const EdgeResponse b = slanted_edge(turned, kHeight, kWidth);
  const EdgeResponse c = slanted_edge(edge(5, 0.5, 500, 100), kWidth, kHeight);
  EXPECT_TRUE(b.is_horizontal);
  EXPECT_NEAR(a.mtf50.value(), b.mtf50.value(), 1e-12);
  EXPECT_NEAR(a.mtf50.value(), c.mtf50.value(), 1e-9);
}

TEST(SlantedEdge, ObjectsInSentences) {
  const auto refused = [](const std::vector<double>& values, int width, int height, const std::string& text) {
    test::expect_error([&] { (void)slanted_edge(values, width, height); }, ErrorCode::input, text);
  };
  refused(std::vector<double>(100, 1), 10, 10, "allowed from 16 x 16 on");
  refused(std::vector<double>(400, 1), 20, 20, "there is no edge");
  refused(edge(0, 0.5), kWidth, kHeight, "slanted by 0.00 degrees");
  refused(edge(43, 0.5), kWidth, kHeight, "allowed 1 to 40");
}

TEST(SlantedEdge, BearsNoise) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.8 / 12);
  std::vector<double> values = edge(5, 0.5);
  for (double& value : values) value += noise(random);
  EXPECT_NEAR(slanted_edge(values, kWidth, kHeight).mtf50.value(),
              slanted_edge(edge(5, 0.5), kWidth, kHeight).mtf50.value(), 0.03);
}

// Two patches on one side of the edge, a bright line along it, and a pixel that is not a number.
TEST(SlantedEdge, RefusesWhatIsNone) {
  const auto refused = [](const std::vector<double>& values, const std::string& text) {
    test::expect_error([&] { (void)slanted_edge(values, kWidth, kHeight); }, ErrorCode::input, text);
  };
  const std::vector<double> other = edge(5, 0.5);
  std::vector<double> patches = other;
  for (std::size_t i = patches.size() / 2; i < patches.size(); ++i)
    patches[i] = 0.1 + 0.4 * (patches[i] - 0.1);
  refused(patches, "these pixels show no single straight edge: the distance from one does not explain 2");
  std::vector<double> line = other;
  for (std::size_t i = line.size() - 1; i % kWidth >= 4 || i > kWidth; --i)
    if (i % kWidth >= 4) line[i] -= 0.7 * (other[i - 4] - 0.1);
  refused(line, "both sides of the line in these pixels are equal");
  std::vector<double> hole = other;
  hole[kWidth + 2] = std::nan("");
  refused(hole, "pixel 2,1 of these is not a finite number (got nan)");
}

}  // namespace
}  // namespace abbe

#include "materials/medium/phase.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>

#include <cmath>
#include <functional>
#include <vector>

#include "tests/angles.h"
#include "tests/materials/random_directions.h"

namespace abbe {
namespace {

struct Example {
  const char* name;
  PhaseFunction phase;
  double mean_cosine;
  double mean_square;  ///< Mean of the squared cosine.
};
Example peaked(const char* name, float g) {
  const double h = static_cast<double>(g);
  return {name, HenyeyGreensteinPhase{g}, h, (1 + 2 * h * h) / 3};  // the Legendre coefficients are g^n
}
const std::vector<Example>& phase_examples() {
  static const std::vector<Example> all{{"isotropic", IsotropicPhase{}, 0, 1.0 / 3},
                                        {"rayleigh", RayleighPhase{}, 0, 2.0 / 5},
                                        peaked("even", 0),
                                        peaked("slight", 1e-4F),
                                        peaked("forward", 0.6F),
                                        peaked("backward", -0.85F),
                                        peaked("sharp", 0.999F),
                                        peaked("sharp back", -0.999F)};
  return all;
}

const Imath::V3f kFrom{0, 0, 1};

Imath::V3f turned_by(double angle) {
  return Imath::V3f(Imath::V3d(std::sin(angle), 0, std::cos(angle)));
}

// Integral of f times the pdf over the sphere, by Simpson's rule in the logarithm of the angle from the peak.
// It is computed in double from the program's float pdf.
double over_sphere(const PhaseFunction& phase, const std::function<double(double)>& f, bool back) {
  constexpr int kSteps = 20000;
  const double low = std::log(1e-7);
  const double high = std::log(kPi);
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double from_end = std::exp(low + (high - low) * i / kSteps);
    const double angle = back ? kPi - from_end : from_end;
    const double value = static_cast<double>(pdf(phase, kFrom, turned_by(angle))) * f(std::cos(angle)) * 2 *
                         kPi * std::sin(angle) * from_end;
    sum += value * (i == 0 || i == kSteps ? 1 : (i % 2 == 1 ? 4 : 2));
  }
  return sum * (high - low) / kSteps / 3;
}

TEST(Phase, DensitiesIntegrateToTheirMoments) {
  for (const Example& e : phase_examples()) {
    const bool back = e.mean_cosine < 0;
    EXPECT_NEAR(over_sphere(
                    e.phase, [](double) { return 1; }, back),
                1, 2e-6)
        << e.name;
    EXPECT_NEAR(over_sphere(
                    e.phase, [](double c) { return c; }, back),
                e.mean_cosine, 2e-6)
        << e.name;
    EXPECT_NEAR(over_sphere(
                    e.phase, [](double c) { return c * c; }, back),
                e.mean_square, 2e-6)
        << e.name;
  }
}

// Cells of equal probability, by the closed forms of the distributions in the angle, and in azimuth.
double cumulative(const PhaseFunction& phase, const Imath::V3d& w) {
  const double back = (Imath::V3d(0, 0, 1) - w).length2() / 2;  // 1 - cos
  const double c = 1 - back;
  if (std::holds_alternative<RayleighPhase>(phase)) return 0.5 - (3 * c + c * c * c) / 8;
  const auto* peak = std::get_if<HenyeyGreensteinPhase>(&phase);
  const double g = peak == nullptr ? 0 : static_cast<double>(peak->g);
  if (std::abs(g) < 1e-3) return back / 2 - 3 * g / 4 * (1 - c * c);
  // Cumulative probability of smaller deflections, from the peak: 1 - (1 - g^2)/(2 g) (1/sqrt(...) - 1/(1 +
  // g)).
  const double sharp = g > 0 ? back : (Imath::V3d(0, 0, 1) + w).length2() / 2;
  const double h = std::abs(g);
  const double root = std::sqrt((1 - h) * (1 - h) + 2 * h * sharp);
  const double share = (1 + h) / (2 * h) * (1 - (1 - h) / root);
  return g > 0 ? share : 1 - share;
}

TEST(Phase, SamplesFollowTheDensityUpToTheSharpestPeaks) {
  constexpr int kRows = 50, kColumns = 8, kSamples = 400000;
  const double level =
      1 - std::pow(1 - 0.01, 1.0 / static_cast<double>(phase_examples().size()));  // Sidak correction
  for (const Example& e : phase_examples()) {
    Uniform random(29);
    std::vector<double> counted(kRows * kColumns, 0.0);
    for (int i = 0; i < kSamples; ++i) {
      const float u = random();
      const PhaseSample s = sample(e.phase, {u, random()});
      const int row =
          std::clamp(static_cast<int>(kRows * cumulative(e.phase, Imath::V3d(s.direction))), 0, kRows - 1);
      const double turn = (std::atan2(s.direction.y, s.direction.x) + kPi) / (2 * kPi);
      const int column = std::clamp(static_cast<int>(kColumns * turn), 0, kColumns - 1);
      counted[static_cast<std::size_t>(row * kColumns + column)] += 1;
    }
    double statistic = 0;
    constexpr double kExpected = static_cast<double>(kSamples) / (kRows * kColumns);
    for (const double count : counted) statistic += (count - kExpected) * (count - kExpected) / kExpected;
    const double p = boost::math::cdf(complement(boost::math::chi_squared(kRows * kColumns - 1), statistic));
    EXPECT_GT(p, level) << e.name;
  }
}

TEST(Phase, SamplesTellTheirDensity) {
  Uniform random(31);
  for (const Example& e : phase_examples())
    for (int i = 0; i < 2000; ++i) {
      const float u = random();
      const PhaseSample s = sample(e.phase, {u, random()});
      ASSERT_NEAR(s.direction.length(), 1, 3e-7) << e.name;
      ASSERT_NEAR(pdf(e.phase, kFrom, s.direction) / s.pdf, 1, 2e-3) << e.name << " " << s.direction.z;
    }
}

TEST(Phase, TheEndsOfTheRandomNumbersAreFinite) {
  for (const Example& e : phase_examples())
    for (const float u : {0.0F, 0x1.fffffep-1F}) {
      const PhaseSample s = sample(e.phase, {u, 0.5F});
      EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf > 0) << e.name;
      EXPECT_NEAR(s.direction.length(), 1, 1e-6) << e.name;
    }
}

}  // namespace
}  // namespace abbe

#include "spectral/interpolation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

namespace abbe {
namespace {

using Function = std::function<double(double)>;

Samples samples_of(const Function& f, std::vector<double> wavelengths_nm) {
  Samples samples{std::move(wavelengths_nm), {}};
  for (const double nm : samples.wavelengths_nm) samples.values.push_back(f(nm));
  return samples;
}

std::vector<double> every(double step_nm, double low_nm, double high_nm) {
  std::vector<double> nm;
  for (double at = low_nm; at <= high_nm; at += step_nm) nm.push_back(at);
  return nm;
}

/// (x - 550)^degree in units of 100 nm.
Function power(int degree) {
  return [degree](double nm) { return std::pow((nm - 550) / 100, degree); };
}

// The worked example of colour-science's SpragueInterpolator, after CIE 167:2005 [CIE167].
TEST(Sprague, AgreesWithAPublishedExample) {
  const std::vector<double> values{5.92, 9.37, 10.8135, 4.51, 69.59, 27.8007, 86.05};
  EXPECT_NEAR(sprague(values, 0.5), 7.21850256056, 5e-12);
  EXPECT_NEAR(sprague(values, 0.25), 6.72951612, 5e-9);
  EXPECT_NEAR(sprague(values, 0.75), 7.81406251, 5e-9);
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(sprague(values, static_cast<double>(i)), values[i], 1e-12) << i;
}

TEST(Sprague, IsExactToDegreeFourInsideAndForLinesAtTheEnds) {
  for (int degree = 0; degree <= 5; ++degree) {
    const Samples samples = samples_of(power(degree), every(10, 400, 700));
    double inside = 0;
    double ends = 0;
    for (double nm = 400; nm <= 700; nm += 0.5) {
      const double error = std::abs(sprague(samples.values, (nm - 400) / 10) - power(degree)(nm));
      double& worst = nm >= 420 && nm <= 680 ? inside : ends;
      worst = std::max(worst, error);
    }
    if (degree <= 4) {
      EXPECT_LT(inside, 1e-13) << degree;
    }
    if (degree == 5) {
      EXPECT_GT(inside, 1e-8) << "the test would not see degree 5";
    }
    if (degree <= 1) {
      EXPECT_LT(ends, 1e-13) << degree;
    }
    if (degree == 2) {
      EXPECT_GT(ends, 1e-4) << "the added values are not exact for parabolas";
    }
  }
}

TEST(Sprague, ValueSlopeAndCurvatureAreContinuous) {
  const std::vector<double> values{5.92, 9.37, 10.8135, 4.51, 69.59, 27.8007, 86.05, 12, 40};
  constexpr double kStep = 1e-3;
  const auto p = [&](double at) { return sprague(values, at); };
  for (int node = 1; node < 8; ++node) {
    const double x = node;
    // One-sided differences of third order, exact to h^3 p''''.
    const auto slope = [&](double h) {
      return (-11 * p(x) + 18 * p(x + h) - 9 * p(x + 2 * h) + 2 * p(x + 3 * h)) / (6 * h);
    };
    const auto curvature = [&](double h) {
      return (2 * p(x) - 5 * p(x + h) + 4 * p(x + 2 * h) - p(x + 3 * h)) / (h * h);
    };
    EXPECT_NEAR(p(std::nextafter(x, 0)), p(x), 1e-11) << node;
    EXPECT_NEAR(slope(kStep), slope(-kStep), 2e-5) << node;
    EXPECT_NEAR(curvature(kStep), curvature(-kStep), 0.1) << node;
  }
}

TEST(Cubic, IsExactToDegreeThreeOnAnyWavelengths) {
  for (const std::vector<double>& nm :
       {every(10, 400, 700), std::vector<double>{400, 404, 420, 421.5, 470, 530, 531, 640, 700}}) {
    for (int degree = 0; degree <= 4; ++degree) {
      const Samples samples = samples_of(power(degree), nm);
      double worst = 0;
      for (double at = 400; at <= 700; at += 0.5)
        worst = std::max(worst, std::abs(cubic(samples, at) - power(degree)(at)));
      if (degree <= 3) {
        EXPECT_LT(worst, 2e-13) << degree;
      }
      if (degree == 4) {
        EXPECT_GT(worst, 1e-5) << "the test would not see degree 4";
      }
    }
  }
}

// The coefficients for 10 nm steps that ASTM E2022 prints [ASTM2022].
TEST(Lagrange, WeightsAreThosePrintedForTenNanometres) {
  const std::vector<double> inner{-10, 0, 10, 20};
  const std::vector<double> outer{0, 10, 20};
  const std::vector<double> third = lagrange_weights(inner, 3);
  const std::vector<double> second = lagrange_weights(outer, 3);
  const std::vector<double> expected_third{-0.0595, 0.7735, 0.3315, -0.0455};
  const std::vector<double> expected_second{0.595, 0.51, -0.105};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(third[i], expected_third[i], 1e-15);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(second[i], expected_second[i], 1e-15);
  EXPECT_EQ(lagrange_weights(inner, 10), (std::vector<double>{0, 0, 1, 0}));
}

TEST(EveryNanometre, KeepsTheSamplesAndFillsWholeNanometresOfTheRange) {
  const Samples samples = samples_of(power(3), {250, 349.5, 450, 500.25, 1099, 1300});
  const Samples fine = every_nanometre(samples, Interpolation::cubic, -1e3, 1e3);
  ASSERT_EQ(fine.values.size(), fine.wavelengths_nm.size());
  EXPECT_EQ(fine.wavelengths_nm.size(), 801U - 2U + samples.values.size()) << "450 and 1099 are samples";
  EXPECT_TRUE(std::is_sorted(fine.wavelengths_nm.begin(), fine.wavelengths_nm.end(), std::less_equal<>{}));
  for (std::size_t i = 0; i < fine.values.size(); ++i)
    EXPECT_NEAR(fine.values[i], power(3)(fine.wavelengths_nm[i]), 1e-11) << fine.wavelengths_nm[i];
}

TEST(EveryNanometre, OvershootIsCutAtTheRange) {
  std::vector<double> nm = every(10, 400, 500);
  const Samples samples = samples_of([](double at) { return at < 450 ? 0.0 : 1.0; }, nm);
  for (const Interpolation rule : {Interpolation::sprague, Interpolation::cubic}) {
    const auto ends = [&](double low, double high) {
      const std::vector<double> values = every_nanometre(samples, rule, low, high).values;
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      return std::pair{*least, *most};
    };
    const auto [least, most] = ends(-10, 10);
    EXPECT_LT(least, -0.05);
    EXPECT_GT(most, 1.05);
    EXPECT_EQ(ends(0, 1), (std::pair{0.0, 1.0}));
  }
  EXPECT_EQ(every_nanometre(samples, Interpolation::linear, 0, 1).values, samples.values);
}

TEST(InterpolationFault, NamesTheSampleAndTheReason) {
  const auto text = [](const std::vector<double>& nm, Interpolation rule) {
    const auto fault = interpolation_fault(nm, rule);
    return fault ? std::to_string(fault->row) + ": " + fault->text : "none";
  };
  const std::vector<double> uneven{400, 410, 420, 430, 450, 460, 470};
  EXPECT_EQ(text(uneven, Interpolation::sprague), "4: a step of 20 nm after one of 10 nm");
  EXPECT_EQ(text(uneven, Interpolation::cubic), "none");
  EXPECT_EQ(text({400, 410, 420, 430, 440}, Interpolation::sprague), "4: 5 samples (allowed 6 or more)");
  EXPECT_EQ(text({400, 410, 420}, Interpolation::cubic), "2: 3 samples (allowed 4 or more)");
  EXPECT_EQ(text({400, 410}, Interpolation::linear), "none");
  EXPECT_EQ(text(every(10.0 / 3, 400, 500), Interpolation::sprague), "none") << "rounding is no step";
}

}  // namespace
}  // namespace abbe

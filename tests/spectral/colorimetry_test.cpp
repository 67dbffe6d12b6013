#include "spectral/colorimetry.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "spectral/color_temperature.h"
#include "spectral/sources.h"
#include "tests/spectral/illuminant.h"

namespace abbe {
namespace {

using test::illuminant;

TEST(Colorimetry, lab_of_white_black_and_the_dark_branch) {
  const XYZ white = {95.047, 100, 108.883};
  EXPECT_NEAR(xyz_to_lab(white, white)[0], 100, 1e-12);
  EXPECT_NEAR(xyz_to_lab(XYZ{}, white)[0], 0, 1e-12);
  // Below (6/29)^3 the lightness is linear: 903.2963 Y/Yn.
  EXPECT_NEAR(xyz_to_lab(XYZ{0, 0.5, 0}, white)[0], 903.2963 * 0.005, 1e-5);
}

TEST(Colorimetry, lab_and_back) {
  const XYZ white{0.9, 1, 0.8};
  for (const XYZ& xyz : {XYZ{0.3, 0.4, 0.1}, XYZ{0.001, 0.002, 0.004}, XYZ{}, white})
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(lab_to_xyz(xyz_to_lab(xyz, white), white)[i], xyz[i], 1e-14);
}

TEST(Colorimetry, chromaticity_of_black) {
  EXPECT_EQ(chromaticity({0, 0, 0}), (std::array<double, 2>{0, 0}));
}

// The CIE prints x = 0.31272, y = 0.32903 for D65; truncated sums differ in the fifth decimal of both.
TEST(Colorimetry, sums_cover_the_whole_observer_unless_a_range_is_given) {
  const Curve d65 = illuminant("D65");
  const auto expect_xy = [](const Chromaticity& xy, double x, double y) {
    EXPECT_NEAR(xy[0], x, 6e-7);
    EXPECT_NEAR(xy[1], y, 6e-7);
  };
  expect_xy(chromaticity(d65), 0.312727, 0.329023);
  expect_xy(chromaticity(d65, Observer::cie1964), 0.313824, 0.330999);
  expect_xy(chromaticity(tristimulus(d65, Curve(1), Observer::cie1931)), 0.312727, 0.329023);
  expect_xy(chromaticity(tristimulus(d65, Curve(1), Observer::cie1931, kVisibleRange)), 0.312739, 0.329052);
  EXPECT_EQ(tristimulus_weights(d65, Observer::cie1931).size(), 471U);
}

// Lines between whole nanometres, and one on a whole nanometre, count by their power, as do those of laser
// light.
TEST(Colorimetry, narrow_lines_count_by_their_power) {
  const std::vector<SpectralLine> three = {{435.8, 0.1, 1}, {546.1, 0.1, 1}, {611, 0.1, 1}};
  const Curve light = lines(three);
  const ColorMatching& seen = color_matching(Observer::cie1931);
  const XYZ exact{integral_of_product(light, seen.x), integral_of_product(light, seen.y),
                  integral_of_product(light, seen.z)};
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(chromaticity(light)[k], chromaticity(exact)[k], 1e-6) << k;
  EXPECT_NEAR(sum_product(light, seen.y), exact[1], 1e-6 * exact[1]);
  const Curve half = band(500, 600);
  EXPECT_NEAR(sum_product(light, seen.y, half) / seen.y(546.1), 1, 1e-4);
  const XYZ mirrored = tristimulus(light, half, Observer::cie1931);
  EXPECT_NEAR(mirrored[1], 100 * seen.y(546.1) / exact[1], 1e-3);
}

// A surface that reflects 0.4 nm of every 5 nm, between whole nanometres, reflects 8 % of any smooth light.
TEST(Colorimetry, narrow_bands_of_a_reflectance_count_by_their_widths) {
  std::vector<Knot> knots;
  for (double nm = 352.5; nm < 850; nm += 5)
    knots.insert(knots.end(), {{nm - 0.2, 0}, {nm - 0.2, 1}, {nm + 0.2, 1}, {nm + 0.2, 0}});
  const Curve comb(knots);
  for (const char* name : {"A", "D65"})
    for (const Observer observer : {Observer::cie1931, Observer::cie1964}) {
      const Curve light = illuminant(name);
      const XYZ reflected = tristimulus(light, comb, observer);
      const XYZ white = tristimulus(light, Curve(1.0), observer);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(reflected[k] / white[k], 0.08, 2e-5) << name << k;
    }
}

// Value that a 1 nm sum uses for a curve at each nanometre.
double told(const Curve& curve, int nm) {
  return sum_product(Curve(1), Curve(1), curve, {nm, nm});
}

// Narrow triangles are distributed by the distances of their peaks, a jump by the areas under two sides.
TEST(Colorimetry, what_lies_between_nanometres_is_shared_among_the_two_around_it) {
  const auto triangle = [](double nm) { return Curve({{nm - 0.125, 0}, {nm, 8}, {nm + 0.125, 0}}); };
  EXPECT_NEAR(told(triangle(700.5), 700), 0.5, 1e-12);
  EXPECT_NEAR(told(triangle(700.5), 701), 0.5, 1e-12);
  EXPECT_NEAR(told(triangle(700.25), 700), 0.75, 1e-12);
  EXPECT_NEAR(told(triangle(700.25), 701), 0.25, 1e-12);
  EXPECT_EQ(told(triangle(700.5), 699), 0);
  EXPECT_EQ(told(triangle(700.5), 702), 0);
  const Curve jump({{540.5, 0}, {540.5, 1}});
  EXPECT_EQ(told(jump, 539), 0);
  EXPECT_NEAR(told(jump, 540), 1.0 / 8, 1e-12);
  EXPECT_NEAR(told(jump, 541), 7.0 / 8, 1e-12);
  EXPECT_NEAR(told(jump, 542), 1, 1e-12);
}

// At the ends of all curves, the mean is taken over half a triangle.
TEST(Colorimetry, nanometres_at_the_ends_of_curves_count_by_their_means_too) {
  const SumRange whole{kMinWavelengthNm, kMaxWavelengthNm};
  const Curve one({{300, 1}, {300.25, 1}, {480.5, 1}, {1099.7, 1}, {1100, 1}});
  EXPECT_NEAR(sum_product(Curve(1), Curve(1), one, whole), 801, 801e-12);
  EXPECT_NEAR(sum_product(Curve(1), Curve(1), one), 471, 471e-12);
  const Curve rise({{300, 0}, {480.5, 180.5}, {1100, 800}});
  EXPECT_NEAR(told(rise, 300), 1.0 / 3, 1e-12);
  EXPECT_NEAR(told(rise, 301), 1, 1e-12);
  EXPECT_NEAR(told(rise, 480), 180, 180e-12);
  EXPECT_NEAR(told(rise, 1099), 799, 799e-12);
  EXPECT_NEAR(told(rise, 1100), 800 - 1.0 / 3, 800e-12);
}

// A knot between nanometres changes no other value.
TEST(Colorimetry, integral_and_sum_of_a_smooth_reflectance_agree) {
  const Curve light = illuminant("D65");
  const XYZ summed = tristimulus(light, Curve({{380, 0.2}, {780, 0.8}}), Observer::cie1931);
  const XYZ integrated =
      tristimulus(light, Curve({{380, 0.2}, {480.5, 0.35075}, {780, 0.8}}), Observer::cie1931);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(integrated[k] / summed[k], 1, 2e-6) << k;
}

// Curves that whole nanometres resolve are summed as the CIE defines.
TEST(Colorimetry, tables_of_whole_nanometres_are_summed) {
  const Curve light = illuminant("FL11");
  const Curve line({{540, 0}, {541, 1}, {542, 0}});
  const ColorMatching& seen = color_matching(Observer::cie1931);
  double lit = 0;
  double lined = 0;
  for (int nm = 360; nm <= 830; ++nm) {
    lit += light(nm) * seen.y(nm);
    lined += light(nm) * seen.y(nm) * line(nm);
  }
  EXPECT_DOUBLE_EQ(sum_product(light, seen.y), lit);
  EXPECT_DOUBLE_EQ(sum_product(light, seen.y, line), lined);
  EXPECT_DOUBLE_EQ(tristimulus(light, line, Observer::cie1931)[1], 100 / lit * light(541) * seen.y(541));
}

// Rises over 0.9 nm between whole nanometres and then falls to zero.
Curve sawtooth() {
  std::vector<Knot> knots;
  for (const double nm : {410, 540, 612})
    knots.insert(knots.end(), {{nm + 0.05, 0}, {nm + 0.95, 5}, {nm + 0.96, 0}});
  return Curve(knots);
}

// Integral of three curves by midpoints of 1/4000 nm, which resolve all knots.
double by_midpoints(const Curve& a, const Curve& b, const Curve& c) {
  constexpr int kParts = 4000;
  double total = 0;
  for (int i = 0; i < 400 * kParts; ++i) {
    const double nm = 380 + (i + 0.5) / kParts;
    if (const double value = a(nm); value != 0) total += value * b(nm) * c(nm) / kParts;
  }
  return total;
}

TEST(Colorimetry, lamps_that_bend_between_nanometres_are_integrated) {
  const Curve lamp = sawtooth();
  const ColorMatching& seen = color_matching(Observer::cie1931);
  const double k = 100 / by_midpoints(lamp, seen.y, Curve(1));
  const Curve steep({{400, 0.2}, {410, 0.1}, {411, 0.9}, {540, 0.9}, {541, 0}, {600, 1}});
  for (const Curve& surface : {Curve(1), steep}) {
    const XYZ xyz = tristimulus(lamp, surface, Observer::cie1931);
    EXPECT_NEAR(xyz[0], k * by_midpoints(lamp, seen.x, surface), 1e-4);
    EXPECT_NEAR(xyz[1], k * by_midpoints(lamp, seen.y, surface), 1e-4);
    EXPECT_NEAR(xyz[2], k * by_midpoints(lamp, seen.z, surface), 1e-4);
  }
  const double efficacy = kLuminousEfficacy * by_midpoints(lamp, seen.y, Curve(1)) / (3 * 5 * 0.91 / 2);
  EXPECT_NEAR(luminous_efficacy(lamp), efficacy, 1e-6 * efficacy);
}

// A band or table counts all light between its edges, whichever side of a jump is its value there.
TEST(Colorimetry, lamps_and_channels_that_jump_at_nanometres_are_integrated) {
  const std::vector<double> ends{500, 600};
  const std::vector<double> values{2, 2};
  const ColorMatching& seen = color_matching(Observer::cie1931);
  for (const Curve& lamp : {band(500, 600, 2), table_curve(ends, values, Outside::zero)}) {
    const double k = 100 / by_midpoints(lamp, seen.y, Curve(1));
    for (const Curve& surface : {Curve(1), band(520, 540, 0.5)}) {
      const XYZ xyz = tristimulus(lamp, surface, Observer::cie1931);
      EXPECT_NEAR(xyz[0], k * by_midpoints(lamp, seen.x, surface), 1e-6);
      EXPECT_NEAR(xyz[1], k * by_midpoints(lamp, seen.y, surface), 1e-6);
      EXPECT_NEAR(xyz[2], k * by_midpoints(lamp, seen.z, surface), 1e-6);
    }
    const Curve fluorescent = illuminant("FL11");
    EXPECT_NEAR(sum_product(fluorescent, lamp), by_midpoints(lamp, fluorescent, Curve(1)), 1e-6);
  }
}

// The end of a light's table outside the observer's response does not change the sums of the CIE.
TEST(Colorimetry, tables_that_end_where_little_is_seen_are_summed) {
  const Curve lamp = illuminant("FL11");
  const ColorMatching& seen = color_matching(Observer::cie1931);
  double lit = 0;
  for (int nm = 360; nm <= 780; ++nm) lit += lamp(nm) * seen.y(nm);
  EXPECT_DOUBLE_EQ(sum_product(lamp, seen.y, {360, 780}), lit);
  EXPECT_DOUBLE_EQ(tristimulus(lamp, Curve(1), Observer::cie1931, {360, 780})[1], 100);
}

TEST(Colorimetry, the_perfect_diffuser_has_a_Y_of_100) {
  const Curve bent({{380, 1}, {480.5, 1 + 1e-13}, {780, 1}});
  const std::vector<SpectralLine> at_the_end = {{379.8, 0.1, 1}, {600, 0.1, 1}};
  for (const Curve& lamp : {sawtooth(), lines(at_the_end), planck(2000), illuminant("FL11")}) {
    double sum = 0;
    for (const XYZ& weight : tristimulus_weights(lamp, Observer::cie1931)) sum += weight[1];
    EXPECT_NEAR(sum, 100, 1e-9);
    EXPECT_NEAR(tristimulus(lamp, Curve(1), Observer::cie1931)[1], 100, 1e-9);
    EXPECT_NEAR(tristimulus(lamp, bent, Observer::cie1931)[1], 100, 1e-9);
  }
}

TEST(Photometry, integral_is_exact) {
  // 1 W at the peak of V, in a line one picometre wide.
  const std::vector<SpectralLine> line = {{555, 1e-3, 1}};
  EXPECT_NEAR(photometric(lines(line)), 683.002, 1e-3);
  // Half a nanometre where V rises: its mean over it, by the trapezoid of the table.
  const Curve& v = color_matching(Observer::cie1931).y;
  EXPECT_NEAR(photometric(band(500, 500.5)), 683.002 * 0.25 * (v(500) + v(500.5)), 1e-9);
  // 1 W per nanometre: the trapezoid of V over its whole table.
  EXPECT_NEAR(photometric(Curve(1)), 683.002 * (106.856917 - 0.5 * (v(360) + v(830))), 1e-3);
}

// The trapezoidal rule of 1 nm gives 156.20 lm/W for A, while a sum with both ends whole gives 155.78. The
// exact integral of the tabulated straight lines is 336.851 for FL11.
TEST(Photometry, efficacies_are_those_of_the_trapezoidal_rule) {
  const Curve& v = color_matching(Observer::cie1931).y;
  for (const auto& [name, known] : {std::pair{"A", 156.20}, {"FL11", 336.86}, {"E", 182.46}}) {
    const Curve light = illuminant(name);
    const auto trapezoids = [](auto value) {
      double total = -0.5 * (value(380) + value(780));
      for (int nm = 380; nm <= 780; ++nm) total += value(nm);
      return total;
    };
    const double expected = kLuminousEfficacy * trapezoids([&](int nm) { return light(nm) * v(nm); }) /
                            trapezoids([&](int nm) { return light(nm); });
    EXPECT_NEAR(luminous_efficacy(light), expected, 1e-12 * expected) << name;
    EXPECT_NEAR(luminous_efficacy(light), known, 0.005) << name;
  }
}

TEST(Photometry, fluorescent_lamps_give_more_light_per_watt) {
  const auto efficacy = [](const std::string& name) {
    const Curve light = illuminant(name);
    return photometric(light) / light.integral(380, 780);
  };
  EXPECT_NEAR(efficacy("FL2") / efficacy("A"), 2.16, 0.01);
}

}  // namespace
}  // namespace abbe

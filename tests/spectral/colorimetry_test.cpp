#include "spectral/colorimetry.h"

#include <gtest/gtest.h>

#include "spectral/library.h"
#include "spectral/sources.h"
#include "tests/reference/reference_table.h"

namespace abbe {
namespace {

Curve illuminant(const std::string& name) {
  Diagnostics diagnostics;
  const auto curve = load_illuminant(name, {}, diagnostics);
  EXPECT_TRUE(curve) << diagnostics.text();
  return curve ? curve->curve : Curve();
}

Observer observer(const std::string& degrees) {
  return degrees == "2" ? Observer::cie1931 : Observer::cie1964;
}

std::array<double, 2> white_point(const Curve& curve, Observer by, SumRange range = {}) {
  return chromaticity(tristimulus(curve, Curve(1), by, range));
}

TEST(Colorimetry, column_sums_of_the_observers) {
  const ColorMatching& two = color_matching(Observer::cie1931);
  EXPECT_NEAR(sum_product(two.x, Curve(1), {360, 830}), 106.865469, 5e-7);
  EXPECT_NEAR(sum_product(two.y, Curve(1), {360, 830}), 106.856917, 5e-7);
  EXPECT_NEAR(sum_product(two.z, Curve(1), {360, 830}), 106.892251, 5e-7);
  const ColorMatching& ten = color_matching(Observer::cie1964);
  EXPECT_NEAR(sum_product(ten.x, Curve(1), {360, 830}), 116.64852, 5e-6);
  EXPECT_NEAR(sum_product(ten.y, Curve(1), {360, 830}), 116.661877, 5e-7);
  EXPECT_NEAR(sum_product(ten.z, Curve(1), {360, 830}), 116.673981, 5e-7);
}

TEST(Colorimetry, white_points_of_all_illuminants) {
  const test::ReferenceTable table("white_points");
  ASSERT_EQ(table.rows(), 100U);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& name = table.text(row, "illuminant");
    const Observer by = observer(table.text(row, "observer"));
    const auto [x, y] = white_point(illuminant(name), by);
    EXPECT_NEAR(x, table.number(row, "x_1nm"), 1e-6) << name;
    EXPECT_NEAR(y, table.number(row, "y_1nm"), 1e-6) << name;
    EXPECT_NEAR(x, table.number(row, "x_pub"), 3.5e-4) << name;
  }
}

/// An illuminant beyond its table: D by its components, A by its definition as the Planckian radiator of
/// 2848 K in the scale of c2 = 1.435e-2 m K.
Curve by_definition(const std::string& name) {
  if (name == "A") return planck(2848 * photon_energy(1) / kBoltzmann / 1.435e7);
  if (name[0] == 'D') return daylight(100 * std::stod(name.substr(1)) * 1.4388 / 1.4380);
  return illuminant(name);
}

TEST(Colorimetry, white_points_over_the_whole_observer) {
  const test::ReferenceTable table("white_points");
  int checked = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, "x_full").empty()) continue;
    const std::string& name = table.text(row, "illuminant");
    const auto [x, y] = white_point(by_definition(name), observer(table.text(row, "observer")), {360, 830});
    EXPECT_NEAR(x, table.number(row, "x_full"), 1e-6) << name;
    EXPECT_NEAR(y, table.number(row, "y_full"), 1e-6) << name;
    ++checked;
  }
  EXPECT_GE(checked, 12);
}

TEST(Colorimetry, planckian_locus) {
  const test::ReferenceTable table("planckian");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto [x, y] = white_point(planck(table.number(row, "T_K")), Observer::cie1931, {360, 830});
    EXPECT_NEAR(x, table.number(row, "x"), 1e-6);
    EXPECT_NEAR(y, table.number(row, "y"), 1e-6);
  }
}

void expect_color_checker(const std::string& expected, const std::string& spectra) {
  const test::ReferenceTable table(expected);
  ASSERT_EQ(table.rows(), 120U);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Curve light = illuminant(table.text(row, "illuminant"));
    const Observer by = observer(table.text(row, "observer"));
    Diagnostics diagnostics;
    const std::string& patch = table.text(row, "patch");
    const auto reflectance = load_curve("reflectance", spectra + ":" + patch, {}, diagnostics);
    ASSERT_TRUE(reflectance) << diagnostics.text();
    const XYZ xyz = tristimulus(light, reflectance->curve, by);
    const Lab lab = xyz_to_lab(xyz, tristimulus(light, Curve(1), by));
    const std::array<std::string, 6> names = {"X", "Y", "Z", "L", "a", "b"};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(xyz[i], table.number(row, names[i]), 1e-6) << patch << " " << names[i];
      EXPECT_NEAR(lab[i], table.number(row, names[3 + i]), 1e-5) << patch << " " << names[3 + i];
    }
  }
}

TEST(Colorimetry, color_checker_babelcolor) {
  expect_color_checker("colorchecker_babelcolor_2deg", "colorchecker24_babelcolor_average");
}

TEST(Colorimetry, color_checker_ohta) {
  expect_color_checker("colorchecker_ohta_iso17321_2deg", "colorchecker24_ohta1997");
}

TEST(Colorimetry, lab_of_white_black_and_the_dark_branch) {
  const XYZ white = {95.047, 100, 108.883};
  EXPECT_NEAR(xyz_to_lab(white, white)[0], 100, 1e-12);
  EXPECT_NEAR(xyz_to_lab(XYZ{}, white)[0], 0, 1e-12);
  // Below (6/29)^3 the lightness is linear: 903.2963 Y/Yn.
  EXPECT_NEAR(xyz_to_lab(XYZ{0, 0.5, 0}, white)[0], 903.2963 * 0.005, 1e-5);
}

TEST(Colorimetry, chromaticity_of_black) {
  EXPECT_EQ(chromaticity({0, 0, 0}), (std::array<double, 2>{0, 0}));
}

TEST(Photometry, luminous_efficacy_of_radiation) {
  const test::ReferenceTable table("illuminant_cct_ler");
  const Curve& v = color_matching(Observer::cie1931).y;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const Curve light = illuminant(table.text(row, "illuminant"));
    const double efficacy = kLuminousEfficacy * sum_product(light, v) / sum_product(light, Curve(1));
    EXPECT_NEAR(efficacy, table.number(row, "LER_lm_per_W"), 1e-4) << table.text(row, "illuminant");
  }
}

TEST(Photometry, integral_is_exact) {
  // A watt at the peak of V, in a line a picometre wide.
  const std::vector<SpectralLine> line = {{555, 1e-3, 1}};
  EXPECT_NEAR(photometric(lines(line)), 683.002, 1e-3);
  // Half a nanometre where V rises: mean of V over it, by the trapezoid of its table.
  const Curve& v = color_matching(Observer::cie1931).y;
  EXPECT_NEAR(photometric(band(500, 500.5)), 683.002 * 0.25 * (v(500) + v(500.5)), 1e-9);
  // A constant watt per nanometre: the trapezoid of V over its whole table.
  EXPECT_NEAR(photometric(Curve(1)), 683.002 * (106.856917 - 0.5 * (v(360) + v(830))), 1e-3);
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

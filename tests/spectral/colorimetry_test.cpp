#include "spectral/colorimetry.h"

#include <gtest/gtest.h>

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

// Lines between whole nanometres, and one on one, count by their power, as do those of a lamp of lasers.
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

// A bend off the nanometres changes nothing else.
TEST(Colorimetry, integral_and_sum_of_a_smooth_reflectance_agree) {
  const Curve light = illuminant("D65");
  const XYZ summed = tristimulus(light, Curve({{380, 0.2}, {780, 0.8}}), Observer::cie1931);
  const XYZ integrated =
      tristimulus(light, Curve({{380, 0.2}, {480.5, 0.35075}, {780, 0.8}}), Observer::cie1931);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(integrated[k] / summed[k], 1, 2e-6) << k;
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

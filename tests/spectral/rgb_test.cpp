#include "spectral/rgb.h"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/picture_codec.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"
#include "spectral/matrix3.h"

namespace abbe {
namespace {

void expect_rgb_near(const LinearRgb& a, const LinearRgb& b, double tolerance) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "channel " << c;
}

TEST(Rgb, SpectraHaveTheColoursTheyAreMadeFrom) {
  for (const double r : {0.0, 0.02, 0.5, 1.0})
    for (const double g : {0.0, 0.3, 1.0})
      for (const double b : {0.0, 0.7, 1.0}) {
        const Curve spectrum = rgb_spectrum({r, g, b});
        expect_rgb_near(linear_rgb(spectrum), {r, g, b}, 1e-9);
        EXPECT_GE(spectrum.min(), std::min({r, g, b}));
        EXPECT_LE(spectrum.max(), std::max({r, g, b}));
      }
  EXPECT_TRUE(rgb_spectrum({0.3, 0.3, 0.3}).is_constant());
  EXPECT_NEAR(rgb_spectrum({3e4, 0, 1e3})(700), 3e4, 30) << "lights are not bounded";
}

TEST(Rgb, ColoursAreThoseOfTheTables) {
  Diagnostics diagnostics;
  const auto d65 = load_illuminant("D65", {}, diagnostics);
  ASSERT_TRUE(d65);
  const XYZ red = tristimulus(d65->curve, rgb_basis().red, Observer::cie1931);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(chromaticity(red)[i], kRec709.red[i], 1e-9);
  EXPECT_NEAR(red[1], 21.26, 0.02) << "luminance of the primary [BT709]";
  expect_rgb_near(linear_rgb(Curve(0.25)), {0.25, 0.25, 0.25}, 1e-12);
}

TEST(Rgb, AnImageSaysHowItsValuesAreEncoded) {
  const auto decoded = [](const std::string& space, double value) {
    const auto encoding = recorded_encoding({0, 0, {}, {{kColorSpace, space}}});
    return encoding ? encoding->decoded(value) : std::nan("");
  };
  EXPECT_EQ(decoded("Linear", 0.3), 0.3);
  EXPECT_EQ(decoded("Linear", -0.3), -0.3);
  EXPECT_EQ(decoded("sRGB", 0.3), srgb_decoded(0.3));
  EXPECT_EQ(decoded("Gamma1.8", 0.3), std::pow(0.3, 1.8));
  for (const char* const unknown : {"KodakLog", "Gamma", "Gamma-1", "GammaCorrected"}) {
    EXPECT_TRUE(std::isnan(decoded(unknown, 0.3))) << unknown;
    const auto fault = rec709_fault({0, 0, {}, {{kColorSpace, unknown}}});
    EXPECT_EQ(fault.value_or(""), "its colour space is unknown (got \"" + std::string(unknown) +
                                      "\", allowed linear, sRGB or a gamma)");
  }
  EXPECT_EQ(recorded_encoding({})->decoded(0.3), srgb_decoded(0.3));
  EXPECT_FALSE(rec709_fault({}));
}

// X, Y and Z of a primary after Bradford's transform from D65 to D50, the white of all profiles.
std::string chromaticity_in_profiles(const Chromaticity& xy) {
  const Matrix3 cones(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296);
  const XYZ from = multiply(cones, unit_xyz(kD65));
  const XYZ to = multiply(cones, XYZ{0.9642, 1, 0.8249});
  const Matrix3 adapted =
      cones.inverse() * diagonal({to[0] / from[0], to[1] / from[1], to[2] / from[2]}) * cones;
  const Chromaticity seen = chromaticity(multiply(adapted, unit_xyz(xy)));
  return std::to_string(seen[0]) + " " + std::to_string(seen[1]) + " ";
}

std::string text_in_profiles(const RgbSpace& space) {
  std::string text;
  for (const Chromaticity& xy : {space.red, space.green, space.blue, space.white})
    text += chromaticity_in_profiles(xy);
  return text.substr(0, text.size() - 1);
}

TEST(Rgb, ColoursOfAnotherProfileThanSrgbAreAFault) {
  RgbSpace p3 = kRec709;
  p3.red = {0.68, 0.32};
  p3.green = {0.265, 0.69};
  const auto fault = [](std::map<std::string, std::string> told) {
    return rec709_fault({0, 0, {}, std::move(told)}).value_or("");
  };
  const std::string srgb_text = text_in_profiles(kRec709);
  EXPECT_EQ(fault({{kProfileKey, "sRGB"}, {kPrimariesKey, srgb_text}}), "");
  EXPECT_EQ(fault({{kProfileKey, "p"}, {kPrimariesKey, srgb_text}, {kColorSpace, "Gamma1.8"}}), "");
  EXPECT_NE(fault({{kPrimariesKey, srgb_text}}), "") << "without a profile they are what they are";
  const std::string allowed =
      "allowed the primaries of sRGB, with floats that are linear or codes that are linear, encoded as "
      "sRGB or by a gamma)";
  EXPECT_EQ(fault({{kProfileKey, "Display P3"}, {kPrimariesKey, text_in_profiles(p3)}}),
            "its colours are those of the profile \"Display P3\" (" + allowed);
  EXPECT_EQ(fault({{kProfileKey, "sRGB"}, {kPrimariesKey, srgb_text}, {kColorSpace, "tables"}}),
            "its colours are those of the profile \"sRGB\" (got tables, " + allowed);
  EXPECT_EQ(fault({{kProfileKey, "grey"}, {kColorSpace, "Gamma2.2"}}), "") << "which has no primaries";
  EXPECT_NE(fault({{kPrimariesKey, "nan nan 0.3 0.6 0.15 0.06 0.3127 0.329"}}), "");
  EXPECT_NE(fault({{kPrimariesKey, "wide"}}), "");
}

TEST(Rgb, BasisIsSmoothAndAddsUpToOne) {
  const RgbBasis& basis = rgb_basis();
  for (double nm = 300; nm <= 1100; nm += 0.5) {
    EXPECT_NEAR(basis.red(nm) + basis.green(nm) + basis.blue(nm), 1, 1e-12);
    for (const Curve* curve : {&basis.red, &basis.green, &basis.blue})
      EXPECT_LT(std::abs((*curve)(nm + 1) - (*curve)(nm)), 0.05) << "between neighbouring nanometres";
  }
  EXPECT_EQ(basis.red(900), basis.red(780));
  EXPECT_GT(basis.red(650), 0.99);
  EXPECT_GT(basis.green(540), 0.9);
  EXPECT_GT(basis.blue(440), 0.9);
}

}  // namespace
}  // namespace abbe

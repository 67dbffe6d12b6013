#include "calibration/output/color_spaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "spectral/colorimetry.h"

namespace abbe {
namespace {

using Rgb = std::array<double, 3>;

double luminance(const Rgb& rgb) {
  return multiply(rgb_to_xyz(kRec709), rgb)[1];
}

TEST(Gamut, LeavesWhatFits) {
  const Gamut gamut(kRec709, 1);
  for (const Rgb& rgb : {Rgb{0.2, 0.5, 1}, Rgb{0, 0, 0}, Rgb{1, 1, 1}, Rgb{0, 1, 0}}) {
    const MappedColor mapped = map_into(gamut, rgb);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(mapped.rgb[k], rgb[k], 1e-15);
    EXPECT_FALSE(mapped.outside);
    EXPECT_FALSE(mapped.too_bright);
  }
}

// Offset of a colour from the grey of its luminance, in X and Z.
std::array<double, 2> from_white(const Rgb& rgb) {
  const XYZ xyz = multiply(rgb_to_xyz(kRec709), rgb);
  const XYZ white = unit_xyz(kD65);
  return {xyz[0] - xyz[1] * white[0], xyz[2] - xyz[1] * white[2]};
}

// Luminance and the direction from white in the chromaticity diagram are preserved, and the result is on the
// border of the gamut.
TEST(Gamut, DesaturatesAtEqualLuminanceAndHue) {
  const Gamut gamut(kRec709);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-0.3, 1.2);
  int moved = 0;
  for (int i = 0; i < 1000; ++i) {
    const Rgb rgb{value(random), value(random), value(random)};
    const MappedColor mapped = map_into(gamut, rgb);
    const double lowest = *std::min_element(mapped.rgb.begin(), mapped.rgb.end());
    EXPECT_GE(lowest, 0);
    EXPECT_FALSE(mapped.too_bright);
    if (!(luminance(rgb) > 0.01) || !mapped.outside) continue;
    ++moved;
    EXPECT_NEAR(luminance(mapped.rgb), luminance(rgb), 1e-12);
    const auto before = from_white(rgb);
    const auto after = from_white(mapped.rgb);
    EXPECT_NEAR(before[0] * after[1], before[1] * after[0], 1e-12);
    EXPECT_GE(before[0] * after[0] + before[1] * after[1], 0);
    EXPECT_LT(lowest, 1e-12);
  }
  EXPECT_GT(moved, 300);
}

TEST(Gamut, DimsWhatIsTooBrightAtItsChromaticity) {
  const Gamut gamut(kRec709, 1);
  const MappedColor mapped = map_into(gamut, {0.5, 2, 1});
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(mapped.rgb[k], Rgb({0.25, 1, 0.5})[k], 1e-15);
  EXPECT_TRUE(mapped.too_bright);
  EXPECT_FALSE(mapped.outside);
  // Desaturation alone brings this colour into the gamut.
  const MappedColor spectral = map_into(gamut, {-0.5, 1.05, -0.1});
  EXPECT_TRUE(spectral.outside);
  EXPECT_FALSE(spectral.too_bright);
}

TEST(Gamut, NoLightAndNoNumbersAreBlack) {
  const Gamut gamut(kRec709, 1);
  EXPECT_EQ(map_into(gamut, {0.1, -0.5, 0}).rgb, (Rgb{0, 0, 0}));
  EXPECT_TRUE(map_into(gamut, {0.1, -0.5, 0}).outside);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(map_into(gamut, {0.5, nan, 0.5}).rgb, (Rgb{0, 0, 0}));
  EXPECT_TRUE(map_into(gamut, {0.5, nan, 0.5}).too_bright);
}

TEST(Gamut, WithoutAnUpperEndKeepsBrightColours) {
  const MappedColor mapped = map_into(Gamut(kAcesCg), {9, 4, 0});
  EXPECT_EQ(mapped.rgb, (Rgb{9, 4, 0}));
  EXPECT_FALSE(mapped.too_bright);
}

TEST(Gamut, RoundingIsNotOutside) {
  const Gamut gamut(kRec709, 1);
  EXPECT_FALSE(map_into(gamut, {1e-4, 1e-4, -1e-10}).outside);
  EXPECT_TRUE(map_into(gamut, {1e-4, 1e-4, -1e-8}).outside);
  EXPECT_FALSE(map_into(gamut, {1 + 1e-6, 1, 1}).too_bright);
}

}  // namespace
}  // namespace abbe

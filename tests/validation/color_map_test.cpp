#include "report/display_color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spectral/rgb.h"

namespace abbe {
namespace {

double decoded(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

Lab lab_of(const DisplayColor& color) {
  return xyz_to_lab(multiply(rgb_to_xyz(kRec709), {decoded(color[0]), decoded(color[1]), decoded(color[2])}),
                    unit_xyz(kD65));
}

TEST(ColorMap, LightnessGrowsEvenlyAndEveryColourCanBeShown) {
  for (int i = 0; i <= 255; ++i) {
    const double share = i / 255.0;
    const DisplayColor color = map_color(share);
    EXPECT_TRUE(std::all_of(color.begin(), color.end(), [](double v) { return v >= 0 && v <= 1; })) << i;
    EXPECT_NEAR(lab_of(color)[0], 12 + 80 * share, 1e-6) << i;
  }
}

TEST(ColorMap, NeighboursLookAlikeAndEndsDoNot) {
  for (int i = 0; i < 255; ++i) {
    const Lab a = lab_of(map_color(i / 255.0));
    const Lab b = lab_of(map_color((i + 1) / 255.0));
    EXPECT_LT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 4) << i;
  }
  EXPECT_GT(map_color(0)[2], map_color(0)[0]) << "blue first";
  EXPECT_GT(map_color(1)[0], map_color(1)[2]) << "yellow last";
}

TEST(ColorMap, CyclicColoursGoRoundAtOneLightness) {
  const double chroma = std::hypot(lab_of(cyclic_color(0, 1))[1], lab_of(cyclic_color(0, 1))[2]);
  EXPECT_GT(chroma, 25);
  for (int i = 0; i < 360; ++i) {
    const DisplayColor color = cyclic_color(i / 360.0, 1);
    EXPECT_TRUE(std::all_of(color.begin(), color.end(), [](double v) { return v >= 0 && v <= 1; })) << i;
    const Lab a = lab_of(color);
    const Lab b = lab_of(cyclic_color((i + 1) / 360.0, 1));
    EXPECT_NEAR(a[0], 65, 1e-6) << i;
    EXPECT_NEAR(std::hypot(a[1], a[2]), chroma, 1e-6) << i;
    EXPECT_NEAR(std::hypot(a[1] - b[1], a[2] - b[2]), chroma * std::numbers::pi / 180, 1e-3) << i;
  }
  const Lab grey = lab_of(cyclic_color(0.3, 0));
  EXPECT_NEAR(std::hypot(grey[1], grey[2]), 0, 1e-6);
  const Lab half = lab_of(cyclic_color(0.3, 0.5));
  EXPECT_NEAR(std::hypot(half[1], half[2]), chroma / 2, 1e-6);
}

TEST(ColorMap, ScalesAndClampsAndShowsWhatIsNoNumber) {
  const std::vector<double> values{1, 3, 5, -7, 99, std::nan("")};
  const Image image = false_color(values, 3, 2, 1, 5);
  const auto pixel = [&](std::size_t i) {
    return DisplayColor{image.channels[0].values[i], image.channels[1].values[i],
                        image.channels[2].values[i]};
  };
  const auto same = [&](std::size_t i, const DisplayColor& color) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel(i)[c], color[c], 1e-6) << i;
  };
  same(0, map_color(0));
  same(1, map_color(0.5));
  same(2, map_color(1));
  same(3, map_color(0));
  same(4, map_color(1));
  same(5, {0.5, 0.5, 0.5});
}

}  // namespace
}  // namespace abbe

#include "validation/picture/color_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibration/output/color_spaces.h"

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

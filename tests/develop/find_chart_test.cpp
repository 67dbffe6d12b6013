#include "develop/find_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calibration/chart/measured_patches.h"
#include "develop/linear_image.h"
#include "io/error.h"

namespace abbe {
namespace {

using Corners = std::array<Imath::V2d, 4>;

constexpr int kWidth = 480;
constexpr int kHeight = 360;

const std::vector<XYZ>& colors() {
  static const std::vector<XYZ> kColors = [] {
    Diagnostics diagnostics;
    return load_chart_targets("colorchecker24_after_nov2014", Curve(1.0), {}, diagnostics).value().xyz;
  }();
  return kColors;
}

// X, Y, Z of a chart in a grey room, with cells that fill a parallelogram. Patches take 0.88 of the cells'
// edges, a black frame the rest. Light falls off to half from left to right, with noise of 1 % of white.
Image picture_of_chart(const Corners& corners) {
  const Imath::V2d across = corners[1] - corners[0];
  const Imath::V2d down = corners[3] - corners[0];
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.01);
  const auto color = [&](double x, double y) -> XYZ {
    const Imath::V2d p = Imath::V2d(x, y) - corners[0];
    const double u = 6 * p.cross(down) / across.cross(down);
    const double v = 4 * across.cross(p) / across.cross(down);
    constexpr double kRim = 0.1;
    if (u < -kRim || v < -kRim || u > 6 + kRim || v > 4 + kRim) return {0.35, 0.37, 0.4};
    const bool frame = std::max(std::abs(u - std::floor(u) - 0.5), std::abs(v - std::floor(v) - 0.5)) > 0.44;
    if (frame || u < 0 || v < 0 || u >= 6 || v >= 4) return {0.03, 0.03, 0.03};
    return colors()[static_cast<std::size_t>(v) * 6 + static_cast<std::size_t>(u)];
  };
  Image image{kWidth, kHeight, {{"X", {}}, {"Y", {}}, {"Z", {}}}, {}};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const XYZ xyz = color(x + 0.5, y + 0.5);
      for (std::size_t k = 0; k < 3; ++k)
        image.channels[k].values.push_back(
            static_cast<float>(xyz[k] * (1 - 0.5 * x / kWidth) + noise(random)));
    }
  return image;
}

LinearImage linear(Image image) {
  LinearImage read{std::move(image), {}, {}, {}, ""};
  for (const ImageChannel& channel : read.image.channels) read.channels.push_back(channel.name);
  return read;
}

void expect_near(const Corners& found, const Corners& truth, double pixels) {
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((found[i] - truth[i]).length(), pixels)
        << i << ": " << found[i].x << ", " << found[i].y << " for " << truth[i].x << ", " << truth[i].y;
}

constexpr Corners kSlanted{Imath::V2d(90, 60), {390, 90}, {370, 290}, {70, 260}};

TEST(FindChart, FindsItWhicheverWayUp) {
  for (std::size_t turn = 0; turn < 4; ++turn) {
    Corners corners = kSlanted;
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(turn), corners.end());
    expect_near(find_chart(linear(picture_of_chart(corners))), corners, 1.5);
  }
}

TEST(FindChart, FindsItThroughFiltersInAnyOrderAndThroughMosaics) {
  constexpr Corners kUpsideDown{kSlanted[2], kSlanted[3], kSlanted[0], kSlanted[1]};
  const Image image = picture_of_chart(kUpsideDown);
  Image bands = image;
  for (std::size_t k = 0; k < 3; ++k) bands.channels[k] = {"band", image.channels[2 - k].values};
  expect_near(find_chart(linear(bands)), kUpsideDown, 1.5);

  LinearImage raw = linear(image);
  raw.image.channels = {{"raw", {}}};
  raw.mosaic = Mosaic{2, 2, {0, 1, 1, 2}};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      raw.image.channels[0].values.push_back(
          image.channels[static_cast<std::size_t>(raw.mosaic->at(x, y))]
              .values[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)]);
  expect_near(find_chart(raw), kUpsideDown, 1.5);
}

TEST(FindChart, SaysWhereThereIsNone) {
  const auto refusal = [](Image image) -> std::string {
    try {
      (void)find_chart(linear(std::move(image)));
    } catch (const Error& error) {
      return error.what();
    }
    return "found";
  };
  const std::string none = "no ColorChecker was found";
  for (const int edge : {1, 7, 200}) {
    const auto pixels = static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge);
    Image even{edge, edge, {{"Y", std::vector<float>(pixels, 0.5F)}}, {}};
    EXPECT_EQ(refusal(even).substr(0, none.size()), none) << edge;
    even.channels[0].values.assign(pixels, 0);
    EXPECT_EQ(refusal(even).substr(0, none.size()), none) << edge << ", black";
  }
}

}  // namespace
}  // namespace abbe

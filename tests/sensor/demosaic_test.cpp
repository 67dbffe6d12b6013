#include "sensor/readout/demosaic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <tuple>
#include <vector>

#include "io/error.h"
#include "sensor/film/crop.h"
#include "tests/sensor/bayer.h"

namespace abbe {
namespace {

const std::array<std::string, 3> kRgb{"R", "G", "B"};
const Mosaic kBayer{2, 2, {0, 1, 1, 2}};
// A pattern of 3 x 2 with a channel in one row only.
const Mosaic kOdd{3, 2, {0, 1, 1, 2, 1, 0}};

using Planes = std::function<float(int channel, int x, int y)>;

Image mosaicked(const Mosaic& mosaic, int width, int height, const Planes& scene) {
  Image image{width, height, {{"raw", {}}}, {{"seed", "7"}}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.channels[0].values.push_back(scene(mosaic.at(x, y), x, y));
  return image;
}
float value(const Image& image, int channel, int x, int y) {
  return image.channels[static_cast<std::size_t>(channel)]
      .values[static_cast<std::size_t>(y * image.width + x)];
}

TEST(Demosaic, ConstantPlanesStayConstantToTheBorders) {
  for (const Mosaic& mosaic : {kBayer, kOdd}) {
    const Planes scene = [](int channel, int, int) { return static_cast<float>(channel + 1); };
    const Image planes = demosaic(mosaicked(mosaic, 7, 6, scene), "raw", mosaic, kRgb);
    ASSERT_EQ(planes.channels.size(), 3U);
    EXPECT_EQ(planes.channels[2].name, "B");
    EXPECT_EQ(planes.metadata.at("seed"), "7");
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_EQ(planes.channels[static_cast<std::size_t>(channel)].values,
                std::vector<float>(42, static_cast<float>(channel + 1)));
  }
}

// A crop, and a film merged from areas with gaps between them.
TEST(Demosaic, ConstantPlanesStayConstantToTheBordersOfWhatAFilmHas) {
  for (const auto& [key, told, areas] :
       {std::tuple<const char*, const char*, std::vector<Crop>>{kCropKey, "1,2,6,5", {{1, 2, 6, 5}}},
        {kAreasKey, "0,0,3,6=0:8 4,1,7,5=0:8", {{0, 0, 3, 6}, {4, 1, 7, 5}}}})
    for (const Mosaic& mosaic : {kBayer, kOdd}) {
      const auto is_recorded = [&areas = areas](int x, int y) {
        return std::any_of(areas.begin(), areas.end(),
                           [x, y](const Crop& c) { return x >= c.x0 && x < c.x1 && y >= c.y0 && y < c.y1; });
      };
      const Planes scene = [&](int channel, int x, int y) {
        return is_recorded(x, y) ? static_cast<float>(channel + 1) : 0.0F;
      };
      Image film = mosaicked(mosaic, 7, 6, scene);
      film.metadata[key] = told;
      const Image planes = demosaic(film, "raw", mosaic, kRgb);
      for (int channel = 0; channel < 3; ++channel)
        for (int y = 0; y < 6; ++y)
          for (int x = 0; x < 7; ++x)
            EXPECT_EQ(value(planes, channel, x, y), scene(channel, x, y))
                << key << ' ' << channel << ' ' << x << ' ' << y;
    }
}

// Bilinear interpolation reproduces a linear ramp exactly, in every phase of the pattern.
TEST(Demosaic, RampsOverABayerPatternComeBackExactly) {
  const Planes scene = [](int channel, int x, int y) {
    return static_cast<float>(10 * channel + (channel + 1) * x - 2 * y);
  };
  for (const auto& [name, bayer] : test::kBayerPhases) {
    const Image planes = demosaic(mosaicked(bayer, 8, 8, scene), "raw", bayer, kRgb);
    for (int channel = 0; channel < 3; ++channel)
      for (int y = 1; y < 7; ++y)
        for (int x = 1; x < 7; ++x)
          EXPECT_FLOAT_EQ(value(planes, channel, x, y), scene(channel, x, y)) << name << channel << x << y;
  }
}

TEST(Demosaic, AnImpulseSpreadsToTheNeighboursInTheirShares) {
  const Planes red = [](int, int x, int y) { return x == 2 && y == 2 ? 4.0F : 0.0F; };
  const Image planes = demosaic(mosaicked(kBayer, 6, 6, red), "raw", kBayer, kRgb);
  EXPECT_EQ(value(planes, 0, 2, 2), 4);
  EXPECT_EQ(value(planes, 0, 3, 2), 2);
  EXPECT_EQ(value(planes, 0, 2, 1), 2);
  EXPECT_EQ(value(planes, 0, 3, 3), 1);
  EXPECT_EQ(value(planes, 0, 4, 2), 0);
  EXPECT_EQ(value(planes, 1, 2, 2), 0);
}

TEST(Demosaic, APixelKeepsTheValueOfItsOwnFilter) {
  const Planes green = [](int, int x, int y) { return x == 3 && y == 2 ? 4.0F : 0.0F; };
  const Image planes = demosaic(mosaicked(kBayer, 6, 6, green), "raw", kBayer, kRgb);
  EXPECT_EQ(value(planes, 1, 3, 2), 4);
  EXPECT_EQ(value(planes, 1, 2, 3), 0);
  EXPECT_EQ(value(planes, 1, 2, 2), 1);
}

TEST(Demosaic, FarPixelsWeighLess) {
  const Mosaic sparse{4, 1, {0, 1, 1, 2}};
  const Planes steps = [](int, int x, int) { return x < 4 ? 0.0F : 8.0F; };
  const Image planes = demosaic(mosaicked(sparse, 8, 1, steps), "raw", sparse, kRgb);
  for (int x = 0; x <= 4; ++x) EXPECT_FLOAT_EQ(value(planes, 0, x, 0), static_cast<float>(2 * x)) << x;
}

TEST(Demosaic, AFilmWithoutTheRawPlaneIsAnInputError) {
  const Image film{1, 1, {{"R", {1}}}, {}};
  try {
    (void)demosaic(film, "raw", kBayer, kRgb);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::input);
  }
}

}  // namespace
}  // namespace abbe

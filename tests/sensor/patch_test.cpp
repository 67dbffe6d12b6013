#include "sensor/film/patch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace abbe {
namespace {

// One row of pixels as a patch, with values from 0 to 100.
PatchChannel measured(const std::vector<float>& values, const std::vector<float>& exposed = {}) {
  const auto width = static_cast<double>(values.size());
  const Image image{static_cast<int>(width), 1, {{"Y", values}}, {}};
  const ImageChannel as_exposed{"Y", exposed};
  MeasuredPlanes planes{{&image.channels[0]}, {"Y"}, {}, 100, {}, 0};
  if (!exposed.empty()) planes.exposed = {&as_exposed};
  const PatchOutline outline{"row", {Imath::V2d(0, 0), {width, 0}, {width, 1}, {0, 1}}};
  return measure_patches(image, planes, std::array{outline})[0].channels[0];
}

TEST(Patch, FewPixelsAtTheEndsAreLeftOutAsDefective) {
  std::vector<float> values(200, 20);
  for (std::size_t i = 0; i < 100; ++i) values[i] = 40;
  values[0] = values[1] = 100;
  values[100] = values[101] = 0;
  const PatchChannel patch = measured(values);
  EXPECT_EQ(patch.pixels, 200U);
  EXPECT_EQ(patch.saturated, 2U);
  EXPECT_EQ(patch.black, 2U);
  EXPECT_FALSE(patch.is_saturated());
  EXPECT_FALSE(patch.is_black());
  EXPECT_NEAR(patch.mean, 30, 1e-12);
  EXPECT_NEAR(patch.deviation.value(), 10 * std::sqrt(196.0 / 195), 1e-12);
}

TEST(Patch, MorePixelsAtAnEndAreThereByTheLight) {
  std::vector<float> values(200, 20);
  values[0] = values[1] = values[2] = 100;
  const PatchChannel bright = measured(values);
  EXPECT_TRUE(bright.is_saturated());
  EXPECT_NEAR(bright.mean, (197 * 20 + 300) / 200.0, 1e-12);
  values[0] = values[1] = values[2] = 0;
  EXPECT_TRUE(measured(values).is_black());
  EXPECT_TRUE(measured({100}).is_saturated());
}

// A flat lowers a hot pixel and raises bright corners.
TEST(Patch, PixelsAreSaturatedAsTheyWereExposed) {
  std::vector<float> exposed(200, 60);
  std::vector<float> evened(200, 120);
  exposed[7] = 100;
  evened[7] = 50;
  const PatchChannel patch = measured(evened, exposed);
  EXPECT_EQ(patch.saturated, 1U);
  EXPECT_EQ(patch.mean, 120);
}

// Adjacent patches of 20 pixels in a row, each with its repeating values.
struct Row {
  Image image{0, 1, {{"Y", {}}}, {}};
  std::vector<PatchOutline> outlines;

  explicit Row(const std::vector<std::vector<float>>& patches) {
    constexpr int kPixels = 20;
    for (const std::vector<float>& values : patches) {
      const double left = image.width;
      const double right = left + kPixels;
      outlines.push_back({"patch", {Imath::V2d(left, 0), {right, 0}, {right, 1}, {left, 1}}});
      for (std::size_t i = 0; i < kPixels; ++i) image.channels[0].values.push_back(values[i % values.size()]);
      image.width += kPixels;
    }
  }
  [[nodiscard]] MeasuredPlanes planes(double saturation) const {
    return {{&image.channels[0]}, {"Y"}, {}, saturation};
  }
  [[nodiscard]] std::optional<double> level(double saturation = 1000) const {
    const MeasuredPlanes all = planes(saturation);
    return clipping_levels(image, all, measure_patches(image, all, outlines))[0];
  }
};

const std::vector<float> kNoisy{40, 44, 42, 39, 41};

TEST(Clipping, AnEvenPatchAtTheTopAmongNoisyOnesIsClipped) {
  EXPECT_EQ(Row({kNoisy, {80}, {80}}).level(), 80);
  EXPECT_EQ(Row({kNoisy, {80}, {78, 80, 80, 79}}).level(), 80) << "with one that is clipped in part";
  EXPECT_EQ(Row({kNoisy, {80}, {10}}).level(), 80) << "and an even one in the dark";
  EXPECT_FALSE(Row({kNoisy, {80}}).level(80)) << "as the file declares it";
  EXPECT_FALSE(Row({kNoisy, {80}, {90, 91, 92, 93}}).level()) << "a noisy patch is brighter";
  EXPECT_FALSE(Row({kNoisy, {10}}).level()) << "it is the darkest";
  EXPECT_FALSE(Row({{40}, {60}, {80}}).level()) << "no patch has noise";
  EXPECT_FALSE(Row({{40, 41}, {80}}).level()) << "noise below a step of the codes leaves patches even";
}

// Noise below a step makes some patches uniform by chance, but rarely two channels at the same highest value.
TEST(Clipping, TwoChannelsThatAreEvenAtTheSameValueAreClipped) {
  const auto patch = [](double highest, std::size_t at_highest) {
    return PatchChannel{
        .pixels = 40, .highest = highest, .at_highest = at_highest, .interquartile_levels = 2};
  };
  const std::vector<PatchChannel> red{patch(30, 20), patch(80, 40)};
  const std::vector<PatchChannel> green{patch(20, 9), patch(30, 11), patch(79, 40), patch(80, 40)};
  const std::vector<PatchChannel> partly{patch(40, 10), patch(80, 30)};
  const std::vector<PatchChannel> lower{patch(20, 10), patch(60, 40)};
  EXPECT_EQ(clipping_levels(std::vector{red, green, partly, lower}, 1000),
            (std::vector<std::optional<double>>{80, 80, 80, std::nullopt}));
  EXPECT_EQ(clipping_levels(std::vector{red, partly, lower}, 1000), std::vector<std::optional<double>>(3));
}

TEST(Clipping, PixelsCountAsSaturatedFromThatLevelOn) {
  const Row row({kNoisy, {80}, {78, 80, 80, 79}});
  MeasuredPlanes planes = row.planes(1000);
  planes.clipped_at = {80};
  const std::vector<PatchValues> patches = measure_patches(row.image, planes, row.outlines);
  EXPECT_EQ(patches[0].channels[0].saturated, 0U);
  EXPECT_EQ(patches[1].channels[0].saturated, 20U);
  EXPECT_EQ(patches[2].channels[0].saturated, 10U);
}

// Pixels outside the patches count too.
TEST(Clipping, BrighterPixelsElsewhereShowThatNothingIsClipped) {
  Row row({kNoisy, {80}, {90, 91, 92, 93}});
  row.outlines.pop_back();
  EXPECT_FALSE(row.level());
}

}  // namespace
}  // namespace abbe

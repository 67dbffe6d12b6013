#include "sensor/film/patch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace abbe {
namespace {

// One row of pixels as a patch, of values from 0 to 100.
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

// A flat takes a hot pixel down and bright corners up.
TEST(Patch, PixelsAreSaturatedAsTheyWereExposed) {
  std::vector<float> exposed(200, 60);
  std::vector<float> evened(200, 120);
  exposed[7] = 100;
  evened[7] = 50;
  const PatchChannel patch = measured(evened, exposed);
  EXPECT_EQ(patch.saturated, 1U);
  EXPECT_EQ(patch.mean, 120);
}

}  // namespace
}  // namespace abbe

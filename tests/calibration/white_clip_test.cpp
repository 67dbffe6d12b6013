#include "calibration/output/display.h"

#include <gtest/gtest.h>

#include "spectral/rgb.h"

namespace abbe {
namespace {

// A sensor whose values of a neutral are (4, 2, 1), as in the light of illuminant A.
Matrix3 warm() {
  return rgb_to_xyz(kRec709) * diagonal({0.25, 0.5, 1});
}
Image pixels(const std::vector<float>& r, const std::vector<float>& g, const std::vector<float>& b) {
  return {static_cast<int>(r.size()), 1, {{"R", r}, {"G", g}, {"B", b}}, {}};
}

TEST(WhiteClip, WhatSaturatesIsWhiteAndWhatIsBelowStays) {
  Image film = pixels({8, 2, 8}, {8, 1, 5}, {8, 0.5F, 0.5F});
  clip_to_white(film, {"R", "G", "B"}, warm(), {8, 8, 8});
  const auto value = [&](int k, std::size_t i) {
    return film.channels[static_cast<std::size_t>(k)].values[i];
  };
  for (int k = 0; k < 3; ++k) EXPECT_FLOAT_EQ(value(k, 0), 8.0F / static_cast<float>(1 << k));
  for (int k = 0; k < 3; ++k) EXPECT_EQ(value(k, 1), 2.0F / static_cast<float>(1 << k));
  EXPECT_FLOAT_EQ(value(0, 2), 8);
  EXPECT_FLOAT_EQ(value(1, 2), 4);
  EXPECT_EQ(value(2, 2), 0.5F);
}

TEST(WhiteClip, EachChannelHasASaturationOfItsOwn) {
  Image film = pixels({99}, {99}, {99});
  clip_to_white(film, {"R", "G", "B"}, warm(), {16, 8, 1});
  EXPECT_FLOAT_EQ(film.channels[0].values[0], 4);
  EXPECT_FLOAT_EQ(film.channels[1].values[0], 2);
  EXPECT_FLOAT_EQ(film.channels[2].values[0], 1);
}

TEST(WhiteClip, AFilmWithoutANeutralStays) {
  Image film = pixels({9}, {9}, {9});
  clip_to_white(film, {"R", "G", "B"}, warm() * diagonal({-1, 1, 1}), {8, 8, 8});
  clip_to_white(film, {"R", "G", "B"}, warm(), {8, 8, 0});
  EXPECT_EQ(film.channels[0].values[0], 9);
}

}  // namespace
}  // namespace abbe

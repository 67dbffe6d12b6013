#include "sensor/response/mosaic.h"

#include <gtest/gtest.h>

namespace abbe {
namespace {

const std::vector<std::string> kNames{"R", "G", "B"};

TEST(Mosaic, RepeatsFromTheTopLeftCorner) {
  const Mosaic mosaic{3, 2, {0, 1, 2, 1, 1, 0}};
  EXPECT_EQ(mosaic.at(0, 0), 0);
  EXPECT_EQ(mosaic.at(2, 0), 2);
  EXPECT_EQ(mosaic.at(0, 1), 1);
  EXPECT_EQ(mosaic.at(2, 1), 0);
  EXPECT_EQ(mosaic.at(3, 2), 0);
  EXPECT_EQ(mosaic.at(8, 7), 0);
}

TEST(Mosaic, TravelsAsText) {
  const Mosaic bayer{2, 2, {0, 1, 1, 2}};
  EXPECT_EQ(to_text(bayer, kNames), "R,G/G,B");
  EXPECT_EQ(parse_mosaic("R,G/G,B", kNames), bayer);
  const Mosaic wide{4, 1, {2, 0, 1, 1}};
  EXPECT_EQ(parse_mosaic(to_text(wide, kNames), kNames), wide);
}

TEST(Mosaic, WordsThatAreNoPatternAreRefused) {
  for (const char* words : {"", "R,G/G", "R,G/G,C", "R,G/", "/R", "R,,G"})
    EXPECT_FALSE(parse_mosaic(words, kNames)) << words;
}

}  // namespace
}  // namespace abbe

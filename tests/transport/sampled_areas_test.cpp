#include "transport/render/sample_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <utility>

namespace abbe {
namespace {

constexpr int kEdge = 6;

/// What each pixel holds, one by one.
using Pixels = std::array<std::array<SampleRanges, kEdge>, kEdge>;

Pixels pixels_of(const SampledAreas& areas) {
  Pixels pixels;
  for (const auto& [c, samples] : areas)
    for (int y = c.y0; y < c.y1; ++y)
      for (int x = c.x0; x < c.x1; ++x) {
        SampleRanges& held = pixels.at(static_cast<std::size_t>(y)).at(static_cast<std::size_t>(x));
        EXPECT_TRUE(held.empty()) << "two areas at " << x << ", " << y;
        held = samples;
      }
  return pixels;
}

bool add_to_pixels(Pixels& pixels, const SampledArea& more) {
  for (int y = more.pixels.y0; y < more.pixels.y1; ++y)
    for (int x = more.pixels.x0; x < more.pixels.x1; ++x)
      for (const SampleRange& range : more.samples)
        if (!add(pixels.at(static_cast<std::size_t>(y)).at(static_cast<std::size_t>(x)), range)) return false;
  return true;
}

template <typename Random>
SampledArea any_area(Random& random) {
  const auto pair = [&random] {
    const int a = static_cast<int>(random() % kEdge);
    return std::pair(a, a + 1 + static_cast<int>(random() % static_cast<unsigned>(kEdge - a)));
  };
  const auto [x0, x1] = pair();
  const auto [y0, y1] = pair();
  const std::uint64_t first = random() % 6;
  return {{x0, y0, x1, y1}, {{first, first + 1 + random() % 2}}};
}

TEST(SampledAreas, AgreeWithPixelsOneByOne) {
  std::mt19937 random(1);
  int refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SampledAreas areas;
    Pixels pixels;
    for (int i = 0; i < 10; ++i) {
      const SampledArea more = any_area(random);
      Pixels sum = pixels;
      const bool fits = add_to_pixels(sum, more);
      const SampledAreas before = areas;
      const auto there = add(areas, more);
      ASSERT_EQ(!there, fits);
      refused += fits ? 0 : 1;
      if (fits)
        pixels = sum;
      else
        EXPECT_EQ(areas, before);
      ASSERT_EQ(pixels_of(areas), pixels);
      EXPECT_EQ(parse_sampled_areas(to_text(areas)).value_or(SampledAreas{}), areas);
    }
    // What is missing makes it whole, and the whole is one area.
    const SampledArea all{{0, 0, kEdge, kEdge}, {{0, 8}}};
    for (const SampledArea& gap : missing(areas, all)) ASSERT_FALSE(add(areas, gap));
    EXPECT_EQ(areas, SampledAreas{all});
  }
  EXPECT_GT(refused, 100);
}

TEST(SampledAreas, OneListWhateverTheOrder) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<SampledArea> pieces;
    SampledAreas areas;
    for (int i = 0; i < 6; ++i)
      if (const SampledArea more = any_area(random); !add(areas, more)) pieces.push_back(more);
    std::shuffle(pieces.begin(), pieces.end(), random);
    SampledAreas others;
    for (const SampledArea& piece : pieces) ASSERT_FALSE(add(others, piece));
    EXPECT_EQ(others, areas);
  }
}

TEST(SampledAreas, AreToldAndReadAsText) {
  const SampledAreas areas{
      {{0, 0, 4, 2}, {{0, 8}}}, {{4, 0, 6, 2}, {{0, 4}, {6, 8}}}, {{0, 2, 3, 5}, {{1, 2}}}};
  EXPECT_EQ(to_text(areas), "0,0,4,2=0:8 4,0,6,2=0:4,6:8 0,2,3,5=1:2");
  EXPECT_EQ(parse_sampled_areas(to_text(areas)), areas);
  EXPECT_EQ(bounds(areas), (Crop{0, 0, 6, 5}));
  for (const char* text : {"", "0,0,4,2", "0,0,4,2=", "0,0,4,2=0:8 3,0,6,2=0:4", "0,0,4,2=0:8 0,1,2,3=0:4",
                           "0,0,4=0:8", "0,0,0,2=0:8", "-1,0,4,2=0:8", "0,0,4,2=0:8=1", "0,0,4,2=0:8 "})
    EXPECT_FALSE(parse_sampled_areas(text)) << text;
}

}  // namespace
}  // namespace abbe

#include "transport/render/sample_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

namespace abbe {
namespace {

TEST(SampleRanges, AddKeepsThemSortedAndJoined) {
  SampleRanges ranges;
  EXPECT_TRUE(add(ranges, {8, 12}));
  EXPECT_TRUE(add(ranges, {0, 4}));
  EXPECT_TRUE(add(ranges, {20, 21}));
  EXPECT_EQ(to_text(ranges), "0:4,8:12,20:21");
  EXPECT_TRUE(add(ranges, {4, 8}));
  EXPECT_EQ(to_text(ranges), "0:12,20:21");
  EXPECT_TRUE(add(ranges, {19, 20}));
  EXPECT_TRUE(add(ranges, {21, 22}));
  EXPECT_EQ(to_text(ranges), "0:12,19:22");
}

TEST(SampleRanges, AddRefusesAnyOverlap) {
  SampleRanges ranges{{4, 8}, {12, 16}};
  const SampleRanges before = ranges;
  for (const SampleRange& more : SampleRanges{{4, 8}, {5, 6}, {3, 5}, {7, 9}, {0, 20}, {11, 13}, {15, 30}})
    EXPECT_FALSE(add(ranges, more)) << more.first;
  EXPECT_EQ(ranges, before);
}

TEST(SampleRanges, AgreeWithSetsOfSamples) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 300; ++trial) {
    SampleRanges ranges;
    std::set<std::uint64_t> samples;
    for (int i = 0; i < 8; ++i) {
      const std::uint64_t first = random() % 30;
      const SampleRange more{first, first + 1 + random() % 6};
      std::vector<std::uint64_t> added(more.last - more.first);
      std::iota(added.begin(), added.end(), more.first);
      const bool free = std::none_of(added.begin(), added.end(), [&](auto s) { return samples.contains(s); });
      EXPECT_EQ(add(ranges, more), free);
      if (free) samples.insert(added.begin(), added.end());
    }
    EXPECT_EQ(count(ranges), samples.size());
    EXPECT_EQ(parse_sample_ranges(to_text(ranges)), ranges);
    const std::vector<std::uint64_t> counts = count_per_replicate(ranges, 4);
    for (std::uint64_t r = 0; r < 4; ++r)
      EXPECT_EQ(counts[r], static_cast<std::uint64_t>(std::count_if(samples.begin(), samples.end(),
                                                                    [r](auto s) { return s % 4 == r; })));
    SampleRange wanted{3, 40};
    std::uint64_t missing_count = 0;
    for (const SampleRange& gap : missing(ranges, wanted))
      for (std::uint64_t s = gap.first; s < gap.last; ++s, ++missing_count)
        EXPECT_TRUE(!samples.contains(s) && s >= wanted.first && s < wanted.last) << s;
    const auto there = std::distance(samples.lower_bound(wanted.first), samples.lower_bound(wanted.last));
    EXPECT_EQ(missing_count, wanted.last - wanted.first - static_cast<std::uint64_t>(there));
    for (auto gap = first_missing(ranges, wanted); gap; gap = first_missing(ranges, wanted)) {
      EXPECT_TRUE(gap->first == wanted.first || samples.contains(gap->first - 1));
      EXPECT_TRUE(gap->last == wanted.last || samples.contains(gap->last));
      ASSERT_TRUE(add(ranges, *gap));
    }
    EXPECT_FALSE(first_missing(ranges, wanted));
  }
}

TEST(SampleRanges, OtherTextsAreNone) {
  for (const char* text :
       {"", "3", "3:3", "4:3", "-1:3", "a:b", "0:4,2:6", "0:4:8", "0:99999999999999999999", "0:4,"})
    EXPECT_FALSE(parse_sample_ranges(text)) << text;
}

}  // namespace
}  // namespace abbe

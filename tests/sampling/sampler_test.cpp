#include "sampling/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace abbe {
namespace {

Sampler at(std::uint32_t index, std::uint32_t stream = 7, std::uint32_t sequence = 0,
           Replicate replicate = {}) {
  return {42, Purpose::camera, sequence, stream, index, replicate};
}

TEST(Sampler, IsAPureFunctionOfItsKey) {
  const auto a = at(5).group(3);
  EXPECT_EQ(a, at(5).group(3));
  EXPECT_NE(a, at(5).group(4));
  EXPECT_NE(a, at(6).group(3));
  EXPECT_NE(a, at(5, 8).group(3));
  EXPECT_NE(a, at(5, 7, 1).group(3));
  EXPECT_NE(a, Sampler(43, Purpose::camera, 0, 7, 5).group(3));
  EXPECT_NE(a, Sampler(42, Purpose::light, 0, 7, 5).group(3));
}

TEST(Sampler, EveryDimensionIsStratifiedOverEveryPowerOfTwo) {
  for (const std::uint32_t count : {4U, 64U, 1024U})
    for (std::uint32_t group = 0; group < 8; ++group)
      for (std::size_t d = 0; d < 4; ++d) {
        std::set<std::uint32_t> strata;
        for (std::uint32_t i = 0; i < count; ++i) {
          const float u = at(i).group(group)[d];
          ASSERT_GE(u, 0.0F);
          ASSERT_LT(u, 1.0F);
          strata.insert(static_cast<std::uint32_t>(u * static_cast<float>(count)));
        }
        EXPECT_EQ(strata.size(), count) << "group " << group << " dimension " << d;
      }
}

TEST(Sampler, TheFirstTwoDimensionsAreANetInEveryShape) {
  // A (0, 2)-sequence puts one of 256 points in each of 2^a x 2^(8-a) boxes.
  for (std::uint32_t a = 0; a <= 8; ++a) {
    std::set<std::uint32_t> boxes;
    for (std::uint32_t i = 0; i < 256; ++i) {
      const auto u = at(i).group(0);
      const auto x = static_cast<std::uint32_t>(u[0] * static_cast<float>(1U << a));
      const auto y = static_cast<std::uint32_t>(u[1] * static_cast<float>(1U << (8 - a)));
      boxes.insert(x << 8 | y);
    }
    EXPECT_EQ(boxes.size(), 256U) << a;
  }
}

TEST(Sampler, StreamsAndGroupsAreUncorrelated) {
  constexpr std::uint32_t kCount = 4096;
  double across_streams = 0;
  double across_groups = 0;
  for (std::uint32_t s = 0; s < kCount; ++s) {
    across_streams += (at(0, s).group(0)[0] - 0.5) * (at(0, s + 1).group(0)[0] - 0.5);
    across_groups += (at(0, s).group(0)[0] - 0.5) * (at(0, s).group(1)[0] - 0.5);
  }
  const double five_sigma = 5 / 12.0 / std::sqrt(kCount);
  EXPECT_LT(std::abs(across_streams / kCount), five_sigma);
  EXPECT_LT(std::abs(across_groups / kCount), five_sigma);
}

TEST(Sampler, IntegratesASmoothFunctionFasterThanChance) {
  constexpr std::uint32_t kCount = 1024;
  double sum = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const auto u = at(i).group(2);
    sum += static_cast<double>(u[0]) * u[1] * u[2] * u[3] * 16;
  }
  // Independent points would have a standard error of sqrt((4/3)^4 - 1)/32 = 0.046.
  EXPECT_NEAR(sum / kCount, 1, 0.005);
}

TEST(Sampler, BranchesHaveStratifiedNumbersOfTheirOwn) {
  std::set<std::uint32_t> boxes;
  for (std::uint32_t i = 0; i < 256; ++i) {
    const auto u = at(i).branch(3).group(0);
    boxes.insert(static_cast<std::uint32_t>(u[0] * 16) << 8 | static_cast<std::uint32_t>(u[1] * 16));
    for (std::uint32_t group = 0; group < 8; ++group) {
      EXPECT_NE(u, at(i).group(group));
      EXPECT_NE(u, at(i).branch(group == 3 ? 4 : group).group(0));
    }
  }
  EXPECT_EQ(boxes.size(), 256U);
}

TEST(Sampler, PartsOfPathsFollowEachOtherInOneSequence) {
  for (std::uint32_t i = 0; i < 16; ++i)
    for (const int bits : {0, 1, 2})
      for (std::uint32_t number = 0; number < 1U << bits; ++number)
        for (const Replicate replicate : {Replicate{0, 1}, Replicate{5, 8}}) {
          const Sampler whole(1, Purpose::camera, 0, 3, i, replicate);
          const Sampler part(1, Purpose::camera, 0, 3, (i << bits) + number, replicate);
          for (std::uint32_t group = 0; group < 4; ++group)
            EXPECT_EQ(whole.split_child(number, bits).group(group), part.group(group)) << i << " " << number;
        }
}

TEST(Sampler, TwoGroupsAreThoseOfEach) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const auto [first, second] = at(i * 7919, i).two_groups(i);
    EXPECT_EQ(first, at(i * 7919, i).group(i));
    EXPECT_EQ(second, at(i * 7919, i).group(i + 1));
  }
}

// Number of boxes of 2^a x 2^b that contain one of these points.
std::size_t boxes(const std::vector<std::array<float, 4>>& points, std::uint32_t a, std::uint32_t b) {
  std::set<std::uint32_t> met;
  for (const std::array<float, 4>& u : points)
    met.insert(static_cast<std::uint32_t>(u[0] * static_cast<float>(1U << a)) << 16 |
               static_cast<std::uint32_t>(u[1] * static_cast<float>(1U << b)));
  return met.size();
}

// The first n points of R replicates are a net of Rn points for every box shape. Those of each replicate are
// a net too, except that two points may fall into the same box.
TEST(Sampler, ReplicatesArePartsOfOneNet) {
  constexpr std::uint32_t kDigits = 6;
  for (const std::uint32_t digits : {1U, 2U, 3U})
    for (std::uint32_t group = 0; group < 16; ++group) {
      std::vector<std::array<float, 4>> all;
      for (std::uint32_t r = 0; r < 1U << digits; ++r) {
        std::vector<std::array<float, 4>> own;
        for (std::uint32_t i = 0; i < 1U << kDigits; ++i)
          own.push_back(at(i, 7, 0, {r, 1U << digits}).group(group));
        for (std::uint32_t a = 0; a <= kDigits; ++a)
          EXPECT_GE(2 * boxes(own, a, kDigits - a), own.size()) << group << ", " << r << ": " << a;
        all.insert(all.end(), own.begin(), own.end());
      }
      for (std::uint32_t a = 0; a <= kDigits + digits; ++a)
        EXPECT_EQ(boxes(all, a, kDigits + digits - a), all.size()) << group << ": " << a;
    }
}

// Variance of means over points, and its estimate from the spread of the replicates.
struct Spread {
  double variance = 0;
  double told = 0;
};

template <typename Function>
Spread spread(const Function& function, bool parted) {
  constexpr std::uint32_t kReplicates = 4;
  constexpr std::uint32_t kPoints = 16;
  constexpr std::uint32_t kStreams = 4000;
  Spread found;
  double sum = 0;
  double squares = 0;
  for (std::uint32_t stream = 0; stream < kStreams; ++stream) {
    std::array<double, kReplicates> means{};
    for (std::uint32_t r = 0; r < kReplicates; ++r)
      for (std::uint32_t i = 0; i < kPoints; ++i) {
        const Sampler sampler = parted ? at(i, stream, 0, {r, kReplicates}) : at(i, stream, r);
        means.at(r) += function(sampler.group(2), sampler.group(3)) / kPoints;
      }
    double mean = 0;
    for (const double of_replicate : means) mean += of_replicate / kReplicates;
    for (const double of_replicate : means)
      found.told += std::pow(of_replicate - mean, 2) / (kReplicates * (kReplicates - 1.0)) / kStreams;
    sum += mean / kStreams;
    squares += mean * mean / kStreams;
  }
  found.variance = squares - sum * sum;
  return found;
}

// Independent sequences estimate their own variance. Replicates of one sequence have less, and estimate more
// than they have. Products of two groups are random in both cases.
TEST(Sampler, ReplicatesRepelEachOther) {
  using Numbers = std::array<float, 4>;
  const auto smooth = [](const Numbers& u, const Numbers&) {
    return static_cast<double>(std::exp(2 * u[0] + u[2]));
  };
  const auto edged = [](const Numbers& u, const Numbers&) { return u[0] + u[1] + u[2] < 1.3F ? 1.0 : 0.0; };
  const auto product = [](const Numbers& u, const Numbers& v) {
    return 12 * (static_cast<double>(u[0]) - 0.5) * (static_cast<double>(v[0]) - 0.5);
  };
  for (const auto& [ours, theirs] : {std::pair(spread(smooth, true), spread(smooth, false)),
                                     std::pair(spread(edged, true), spread(edged, false))}) {
    EXPECT_NEAR(theirs.told / theirs.variance, 1, 0.1);
    EXPECT_LT(ours.variance, 0.6 * theirs.variance);
    EXPECT_GT(ours.told, 1.5 * ours.variance);
  }
  const Spread ours = spread(product, true);
  EXPECT_NEAR(ours.told / ours.variance, 1, 0.15);
  EXPECT_LT(ours.variance, 1.1 * spread(product, false).variance);
}

// Bit by bit: the index is shuffled, and each dimension of its point scrambled as in [Burley2020], both
// between bit reversals.
std::uint32_t reversed(std::uint32_t x) {
  std::uint32_t y = 0;
  for (int bit = 0; bit < 32; ++bit) y |= ((x >> bit) & 1U) << (31 - bit);
  return y;
}
std::uint32_t mixed(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}
std::uint32_t combined(std::uint32_t a, std::uint32_t b) {
  return mixed(a ^ (mixed(b) + 0x9e3779b9U));
}
std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x) + seed;
  for (const std::uint32_t factor : {0x6c50b47cU, 0xb82f1e52U, 0xc7afe638U, 0x8d22f6e6U}) x ^= x * factor;
  return reversed(x);
}
std::uint32_t shuffled(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x);
  for (const std::uint32_t factor :
       {seed & ~1U, 0x6c50b47cU, 0xb82f1e52U, std::rotl(seed, 16) & ~1U, 0xc7afe638U, 0x8d22f6e6U})
    x ^= x * factor;
  return reversed(x) ^ reversed(seed & 0xe0000000U);
}
// The first two dimensions of Sobol's sequence (bit reversal and Pascal's triangle), and the first three bits
// of the dimension that numbers the replicates.
std::array<std::uint32_t, 3> sobol(std::uint32_t i) {
  std::array<std::uint32_t, 3> point{};
  std::uint32_t column = 1U << 31;
  std::array<std::uint32_t, 3> parting{1, 2, 5};
  for (int bit = 0; bit < 32; ++bit, column ^= column >> 1) {
    if ((i >> bit) & 1U) point = {point[0] ^ 1U << (31 - bit), point[1] ^ column, point[2] ^ parting[0]};
    parting = {parting[1], parting[2], parting[2] ^ parting[0]};
  }
  return point;
}

TEST(Sampler, NumbersAreThoseOfItsDefinition) {
  std::uint32_t index = 1;
  for (std::uint32_t group = 0; group < 1000; ++group, index = mixed(index)) {
    const std::uint32_t of = 1U << group % 4;
    const Replicate replicate{index >> 29 & (of - 1), of};
    std::uint32_t key = 42;
    for (const std::uint32_t part : {0U, 1U, 3U, 7U, group}) key = combined(key, part);
    const std::uint32_t at_index = index % (1U << Sampler::kIndexBits);
    const std::uint32_t slice = replicate.number ^ (key & (of - 1));
    std::uint32_t in_all = shuffled(at_index, mixed(key + replicate.number + 1)) * of;
    while ((sobol(in_all)[2] & (of - 1)) != slice) ++in_all;
    const auto point = sobol(in_all);
    const auto u = at(at_index, 7, 3, replicate).group(group);
    for (std::uint32_t d = 0; d < 2; ++d)
      ASSERT_EQ(u[d], static_cast<float>(owen_scrambled(point[d], combined(key, d + 1)) >> 8) * 0x1p-24F)
          << "group " << group << " dimension " << d;
  }
}

}  // namespace
}  // namespace abbe

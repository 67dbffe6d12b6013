#include "sampling/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace abbe {
namespace {

Sampler at(std::uint32_t index, std::uint32_t stream = 7, std::uint32_t replicate = 0) {
  return {42, Purpose::camera, replicate, stream, index};
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

TEST(Sampler, TwoGroupsAreThoseOfEach) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const auto [first, second] = at(i * 7919, i).two_groups(i);
    EXPECT_EQ(first, at(i * 7919, i).group(i));
    EXPECT_EQ(second, at(i * 7919, i).group(i + 1));
  }
}

// [Burley2020] bit by bit: the index is shuffled and each dimension of its point scrambled, both between
// reversals of bits.
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
// The first two dimensions of Sobol's sequence: bits reversed, and Pascal's triangle.
std::array<std::uint32_t, 2> sobol(std::uint32_t i) {
  std::array<std::uint32_t, 2> point{};
  std::uint32_t column = 1U << 31;
  for (int bit = 0; bit < 32; ++bit, column ^= column >> 1)
    if ((i >> bit) & 1U) point = {point[0] ^ 1U << (31 - bit), point[1] ^ column};
  return point;
}

TEST(Sampler, NumbersAreThoseOfItsDefinition) {
  std::uint32_t index = 1;
  for (std::uint32_t group = 0; group < 1000; ++group, index = mixed(index)) {
    std::uint32_t key = 42;
    for (const std::uint32_t part : {0U, 1U, 3U, 7U, group}) key = combined(key, part);
    const auto point = sobol(owen_scrambled(index, key));
    const auto u = at(index, 7, 3).group(group);
    for (std::uint32_t d = 0; d < 2; ++d)
      ASSERT_EQ(u[d], static_cast<float>(owen_scrambled(point[d], combined(key, d + 1)) >> 8) * 0x1p-24F)
          << "group " << group << " dimension " << d;
  }
}

}  // namespace
}  // namespace abbe

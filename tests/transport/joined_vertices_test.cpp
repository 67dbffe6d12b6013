#include "transport/path/connect.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace abbe {
namespace {

// About 8 (1 + ln(N/8)) of N vertices are connected, the first eight always. Their weights sum to N on
// average, and to the length of any part of the path.
TEST(JoinedVertices, StandForAllOfALongPath) {
  PathVertex vertex;
  vertex.at = MediumVertex{Imath::V3f(0), Imath::V3f(0), {}};
  const std::vector<PathVertex> path(1000, vertex);
  std::vector<JoinedVertex> joined;
  constexpr std::uint32_t kPaths = 4096;
  double sum_up_to_40 = 0;
  double sum = 0;
  double most = 0;
  for (std::uint32_t i = 0; i < kPaths; ++i) {
    choose_joined(path, Sampler(1, Purpose::camera, 0, 0, i), joined);
    ASSERT_GE(joined.size(), 8U);
    most = std::max(most, std::abs(static_cast<double>(joined.size()) - 8 * (1 + std::log(1000.0 / 8))));
    for (const JoinedVertex& vertex : joined) {
      const auto count = static_cast<double>(vertex.weight);
      sum += count;
      if (vertex.number <= 40) sum_up_to_40 += count;
    }
    EXPECT_EQ(joined[7].number, 8U);
    EXPECT_EQ(joined[7].weight, 1);
  }
  EXPECT_LT(most, 2);
  EXPECT_NEAR(sum_up_to_40 / kPaths, 40, 0.1);
  EXPECT_NEAR(sum / kPaths, 1000, 3);
}

}  // namespace
}  // namespace abbe

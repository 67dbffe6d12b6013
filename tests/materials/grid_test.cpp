#include "materials/medium/medium.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/materials/random_directions.h"

namespace abbe {
namespace {

constexpr float kForever = std::numeric_limits<float>::infinity();

PlacedGrid ragged() {
  Uniform random(3);
  DensityGrid grid{{5, 4, 3}, {}};
  for (int i = 0; i < 60; ++i) grid.density.push_back(i % 7 == 0 ? 0.0F : random());
  return {std::make_shared<const DensityGrid>(std::move(grid)), {-1, 2, 0}, {3, 4, 0.5}};
}

// Trilinear interpolation from the definition.
double density(const PlacedGrid& placed, const Imath::V3d& at) {
  const auto& n = placed.grid->size;
  double sum = 0;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        double weight = 1;
        const Imath::V3i node(x, y, z);
        for (int axis = 0; axis < 3; ++axis) {
          const double across = (at[axis] - placed.from[axis]) / (placed.to[axis] - placed.from[axis]);
          if (across < 0 || across > 1) return 0;
          weight *=
              std::max(0.0, 1 - std::abs(across * (n[static_cast<std::size_t>(axis)] - 1) - node[axis]));
        }
        sum += weight *
               static_cast<double>(placed.grid->density[static_cast<std::size_t>((z * n[1] + y) * n[0] + x)]);
      }
  return sum;
}

struct Line {
  Imath::V3f origin, direction;
};
Line random_line(Uniform& random) {
  const auto inside = [&] { return Imath::V3f(4 * random() - 1, 2 + 2 * random(), 0.5F * random()); };
  const Imath::V3f direction = (inside() - inside()).normalized();
  return {inside() - direction * (6 * random() - 1), direction};
}

TEST(DensityGrid, ColumnsAreTheIntegralOfDensity) {
  const PlacedGrid grid = ragged();
  Uniform random(5);
  for (int i = 0; i < 100; ++i) {
    const Line line = random_line(random);
    const float distance = i % 4 == 0 ? kForever : 8 * random();
    const GridSegment stretch = grid.march(line.origin, line.direction, distance, kForever);
    constexpr int kSteps = 20000;
    const double length = std::min(12.0, static_cast<double>(distance));
    double sum = 0;
    for (int k = 0; k < kSteps; ++k)
      sum += density(grid,
                     Imath::V3d(line.origin) + Imath::V3d(line.direction) * (length * (k + 0.5) / kSteps)) *
             length / kSteps;
    ASSERT_NEAR(stretch.column, sum, 2e-3 * sum + 1e-5) << i;
    ASSERT_FALSE(stretch.reached);
    ASSERT_EQ(stretch.distance, distance);
  }
}

TEST(DensityGrid, AColumnEndsWhereItIsReached) {
  const PlacedGrid grid = ragged();
  Uniform random(7);
  int reached = 0;
  for (int i = 0; i < 2000; ++i) {
    const Line line = random_line(random);
    const float whole = grid.march(line.origin, line.direction, kForever, kForever).column;
    if (whole == 0) continue;  // outside the grid
    const float column = whole * (1.2F * random() + 1e-3F);
    const GridSegment stretch = grid.march(line.origin, line.direction, kForever, column);
    ASSERT_EQ(stretch.reached, column <= whole) << column / whole;
    if (!stretch.reached) continue;
    ++reached;
    ASSERT_EQ(stretch.column, column);
    const GridSegment part = grid.march(line.origin, line.direction, stretch.distance, kForever);
    ASSERT_NEAR(part.column, column, 3e-6F + 1e-5F * column) << i;
  }
  EXPECT_GT(reached, 500);
}

// Rays along an axis and through nodes, from inside and from outside, and past the grid.
TEST(DensityGrid, EvenDensityIsTheLength) {
  const PlacedGrid even{
      std::make_shared<const DensityGrid>(DensityGrid{{3, 3, 3}, std::vector<float>(27, 2)}),
      {0, 0, 0},
      {2, 2, 2}};
  const auto column = [&](const Imath::V3f& from, const Imath::V3f& along, float distance) {
    return even.march(from, along, distance, kForever).column;
  };
  EXPECT_FLOAT_EQ(column({-1, 1, 1}, {1, 0, 0}, kForever), 4);
  EXPECT_FLOAT_EQ(column({1, 1, 0.5F}, {0, 0, 1}, kForever), 3);
  EXPECT_FLOAT_EQ(column({1, 1, 0.5F}, {0, 0, -1}, 0.25F), 0.5F);
  const float third = std::sqrt(1.0F / 3);
  EXPECT_NEAR(column({-1, -1, -1}, {third, third, third}, kForever), 4 * std::sqrt(3.0F), 1e-5F);
  EXPECT_EQ(column({-1, 3, 1}, {1, 0, 0}, kForever), 0);
  EXPECT_EQ(column({3, 1, 1}, {1, 0, 0}, kForever), 0);
  EXPECT_EQ(column({-1, 1, 1}, {1, 0, 0}, 0.5F), 0);
}

}  // namespace
}  // namespace abbe

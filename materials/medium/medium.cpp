#include "materials/medium/medium.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abbe {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A ray in grid coordinates, in which nodes are at integers, with its current cell.
class GridLine {
 public:
  GridLine(const PlacedGrid& placed, const Imath::V3d& origin, const Imath::V3d& direction)
      : grid_(*placed.grid) {
    for (int axis = 0; axis < 3; ++axis) {
      const double per_metre = (nodes(axis) - 1) / (placed.to[axis] - placed.from[axis]);
      start_[axis] = (origin[axis] - placed.from[axis]) * per_metre;
      slope_[axis] = direction[axis] * per_metre;
    }
  }

  // Clips [t, end] to the grid; false if nothing is left.
  bool clip(double& t, double& end) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double last = nodes(axis) - 1;
      if (slope_[axis] == 0) {
        if (start_[axis] < 0 || start_[axis] > last) return false;
        continue;
      }
      const double a = -start_[axis] / slope_[axis];
      const double b = (last - start_[axis]) / slope_[axis];
      t = std::max(t, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    return t < end;
  }

  void enter(double t) {
    for (int axis = 0; axis < 3; ++axis) {
      const double at = start_[axis] + t * slope_[axis];
      cell_[axis] = std::clamp(static_cast<int>(at), 0, nodes(axis) - 2);
      leaves_[axis] = slope_[axis] == 0 ? kInfinity : crossing(axis);
    }
    load();
  }
  // The ray parameter at which the ray leaves the cell.
  [[nodiscard]] double leaves() const { return leaves_[next_axis_]; }
  // Moves to the next cell; false outside the grid.
  bool step() {
    const int axis = next_axis_;
    cell_[axis] += slope_[axis] > 0 ? 1 : -1;
    if (cell_[axis] < 0 || cell_[axis] > nodes(axis) - 2) return false;
    leaves_[axis] = crossing(axis);
    load();
    return true;
  }

  // Rounding cannot make the result negative: b - a is rounded to no less than -a if both are 0 or more.
  [[nodiscard]] double density(double t) const {
    Imath::V3d f;
    for (int axis = 0; axis < 3; ++axis)
      f[axis] = std::min(std::max(start_in_cell_[axis] + t * slope_[axis], 0.0), 1.0);
    const auto between = [](double a, double b, double fraction) { return a + fraction * (b - a); };
    std::array<double, 4> rows{};
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = low_x_[i] + f.x * rise_x_[i];
    return between(between(rows[0], rows[1], f.y), between(rows[2], rows[3], f.y), f.z);
  }

 private:
  [[nodiscard]] int nodes(int axis) const { return grid_.size[static_cast<std::size_t>(axis)]; }
  [[nodiscard]] double crossing(int axis) const {
    return (cell_[axis] + (slope_[axis] > 0 ? 1 : 0) - start_[axis]) / slope_[axis];
  }
  void load() {
    const auto row = static_cast<std::size_t>(nodes(0));
    const std::size_t layer = row * static_cast<std::size_t>(nodes(1));
    const float* corner =
        &grid_.density[static_cast<std::size_t>(cell_.x) + row * static_cast<std::size_t>(cell_.y) +
                       layer * static_cast<std::size_t>(cell_.z)];
    for (std::size_t i = 0; i < low_x_.size(); ++i) {
      const float* at = corner + row * (i & 1U) + layer * (i >> 1U);
      low_x_[i] = static_cast<double>(at[0]);
      rise_x_[i] = static_cast<double>(at[1]) - low_x_[i];
    }
    start_in_cell_ = start_ - Imath::V3d(cell_);
    const int xy = leaves_.y < leaves_.x ? 1 : 0;
    next_axis_ = leaves_.z < leaves_[xy] ? 2 : xy;
  }

  const DensityGrid& grid_;
  Imath::V3d start_;
  Imath::V3d slope_;
  Imath::V3i cell_{0, 0, 0};
  Imath::V3d start_in_cell_{0, 0, 0};
  Imath::V3d leaves_{0, 0, 0};
  int next_axis_ = 0;  // the axis along which the ray leaves the cell
  // Densities at the cell corners of lower x, with y running faster than z, and their increase towards higher
  // x.
  std::array<double, 4> low_x_{};
  std::array<double, 4> rise_x_{};
};

double simpson(double length, double first, double center, double last) {
  return length / 6 * (first + 4 * center + last);
}

// The parameter in [a, b], within one cell, at which the integral of density from a is `column`: Newton's
// method, with bisection outside its bracket.
double solve(const GridLine& line, double a, double b, double column) {
  const double at_a = line.density(a);
  double low = a;
  double high = b;
  double t = (a + b) / 2;
  for (int i = 0; i < 50 && high - low > 1e-9 * (b - a); ++i) {
    const double at_t = line.density(t);
    const double excess = simpson(t - a, at_a, line.density((a + t) / 2), at_t) - column;
    (excess > 0 ? high : low) = t;
    const double newton = t - excess / at_t;
    const bool within = newton > low && newton < high;
    if (within && std::abs(newton - t) < 1e-9 * (b - a)) return newton;
    t = within ? newton : (low + high) / 2;
  }
  return t;
}

}  // namespace

GridSegment PlacedGrid::march(const Imath::V3d& origin, const Imath::V3d& direction, float distance,
                              float column) const {
  GridLine line(*this, origin, direction);
  double t = 0;
  auto end = static_cast<double>(distance);
  if (!line.clip(t, end)) return {distance, 0, false};
  const auto wanted = static_cast<double>(column);
  double sum = 0;
  line.enter(t);
  double first = line.density(t);
  while (true) {
    const double next = std::max(t, std::min(line.leaves(), end));
    const double last = line.density(next);
    const double part = simpson(next - t, first, line.density((t + next) / 2), last);
    if (part > 0 && sum + part >= wanted)
      return {static_cast<float>(solve(line, t, next, wanted - sum)), column, true};
    sum += part;
    t = next;
    first = last;  // density is continuous
    if (t >= end || !line.step()) return {distance, static_cast<float>(sum), false};
  }
}

}  // namespace abbe

#include "validation/goniometer/sphere_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <boost/math/quadrature/gauss.hpp>

namespace abbe {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
// Largest solid angle of a cell [sr], since a cell without directions may still have density.
constexpr double kLargestCell = 4 * std::numbers::pi / 128;
// Depth below which float directions cannot be distinguished.
constexpr double kMinDepth = 1e-13;

}  // namespace

SphereCells::SphereCells(std::span<const Imath::V3f> directions, std::size_t max_per_cell) : nodes_(2) {
  std::array<std::vector<PolarPoint>, 2> members;
  for (const Imath::V3f& w : directions) {
    const PolarPoint p = to_polar(w);
    members[p.above ? 1 : 0].push_back(p);
  }
  for (std::size_t above : {0U, 1U})
    build(above, {above == 1, 0, 1, 0, kTwoPi}, std::move(members[above]), max_per_cell);
}

SphereCells::PolarPoint SphereCells::to_polar(const Imath::V3f& w) {
  const Imath::V3d v(w);
  const double phi = std::atan2(v.y, v.x);
  return {w.z > 0, (v.x * v.x + v.y * v.y) / (1 + std::abs(v.z)), phi < 0 ? phi + kTwoPi : phi};
}

Imath::V3f SphereCells::at(bool above, double depth, double phi) {
  const double sine = std::sqrt(depth * (2 - depth));
  return Imath::V3f(Imath::V3d(sine * std::cos(phi), sine * std::sin(phi), above ? 1 - depth : depth - 1));
}

SphereCells::Halves SphereCells::halved(const Cell& cell) {
  const double depth = (cell.depth_low + cell.depth_high) / 2;
  const double phi = (cell.phi_low + cell.phi_high) / 2;
  const double sine = std::sqrt(depth * (2 - depth));
  const bool by_depth = (cell.depth_high - cell.depth_low) / sine >
                        (cell.phi_high - cell.phi_low) * sine;  // angles along both sides
  Halves halves{by_depth, by_depth ? depth : phi, cell, cell};
  (by_depth ? halves.low.depth_high : halves.low.phi_high) = halves.at;
  (by_depth ? halves.high.depth_low : halves.high.phi_low) = halves.at;
  return halves;
}

void SphereCells::build(std::size_t node, const Cell& cell, std::vector<PolarPoint> members,
                        std::size_t max_per_cell) {
  const double height = cell.depth_high - cell.depth_low;
  const double width = cell.phi_high - cell.phi_low;
  if ((members.size() <= max_per_cell && height * width <= kLargestCell) || height < kMinDepth) {
    nodes_[node].leaf = leaves_.size();
    leaves_.push_back(cell);
    return;
  }
  const Halves halves = halved(cell);
  const auto split =
      std::partition(members.begin(), members.end(), [&](const PolarPoint& p) { return halves.in_low(p); });
  std::vector<PolarPoint> second(split, members.end());
  members.erase(split, members.end());
  const std::size_t first_child = nodes_.size();
  nodes_[node] = {first_child, 0, halves.by_depth, halves.at};
  nodes_.resize(first_child + 2);
  build(first_child, halves.low, std::move(members), max_per_cell);
  build(first_child + 1, halves.high, std::move(second), max_per_cell);
}

std::size_t SphereCells::cell_of(const Imath::V3f& w) const {
  return cell_of(to_polar(w));
}

std::size_t SphereCells::cell_of(const PolarPoint& p) const {
  std::size_t node = p.above ? 1 : 0;
  while (nodes_[node].first_child != 0) {
    const double value = nodes_[node].by_depth ? p.depth : p.phi;
    node = nodes_[node].first_child + (value < nodes_[node].at ? 0 : 1);
  }
  return nodes_[node].leaf;
}

// The quadrature sees zero density if a lobe is narrower than the distances between its nodes, or if an edge
// leaves only a sliver of it in the cell. Further division would confirm that zero. Where a known direction
// has a much larger density than all nodes, the cell is halved around it.
double SphereCells::integral(const Cell& cell, const SphereDensity& density, std::span<KnownDensity> known) {
  constexpr double kTolerance = 1e-6;  // of the integral over the sphere
  constexpr int kQuarterings = 10;
  constexpr double kVisibleRatio = 0.5;
  const RuleSum whole = by_rule(cell, density);
  const auto missed = [&](const KnownDensity& f) { return kVisibleRatio * f.density > whole.max_density; };
  if (cell.depth_high - cell.depth_low < kMinDepth || std::ranges::none_of(known, missed))
    return refined(cell, density, whole.integral, kTolerance, kQuarterings);
  const Halves halves = halved(cell);
  const auto split = std::partition(known.begin(), known.end(),
                                    [&](const KnownDensity& f) { return halves.in_low(f.point); });
  return integral(halves.low, density, {known.begin(), split}) +
         integral(halves.high, density, {split, known.end()});
}

SphereCells::RuleSum SphereCells::by_rule(const Cell& cell, const SphereDensity& density) {
  using Rule = boost::math::quadrature::gauss<double, 5>;
  double max_density = 0;
  const auto along_phi = [&](double depth) {
    return Rule::integrate(
        [&](double phi) {
          const double value = density(at(cell.above, depth, phi));
          max_density = std::max(max_density, value);
          return value;
        },
        cell.phi_low, cell.phi_high);
  };
  const double integral = Rule::integrate(along_phi, cell.depth_low, cell.depth_high);
  return {integral, max_density};
}

// Quarters the cell until the integral converges, since it may contain the edge of a lobe.
double SphereCells::refined(const Cell& cell, const SphereDensity& density, double whole, double tolerance,
                            int quarterings) {
  const double depth = (cell.depth_low + cell.depth_high) / 2;
  const double phi = (cell.phi_low + cell.phi_high) / 2;
  const std::array<Cell, 4> quarters{{{cell.above, cell.depth_low, depth, cell.phi_low, phi},
                                      {cell.above, cell.depth_low, depth, phi, cell.phi_high},
                                      {cell.above, depth, cell.depth_high, cell.phi_low, phi},
                                      {cell.above, depth, cell.depth_high, phi, cell.phi_high}}};
  std::array<double, 4> parts{};
  for (std::size_t i = 0; i < 4; ++i) parts[i] = by_rule(quarters[i], density).integral;
  const double sum = parts[0] + parts[1] + parts[2] + parts[3];
  if (quarterings == 0 || std::abs(sum - whole) < tolerance) return sum;
  double total = 0;
  for (std::size_t i = 0; i < 4; ++i)
    total += refined(quarters[i], density, parts[i], tolerance / 2, quarterings - 1);
  return total;
}

std::vector<double> SphereCells::integrate(const SphereDensity& density,
                                           std::span<const Imath::V3f> known) const {
  std::vector<std::vector<KnownDensity>> members(leaves_.size());
  for (const Imath::V3f& w : known) {
    const PolarPoint p = to_polar(w);
    members[cell_of(p)].push_back({p, density(w)});
  }
  std::vector<double> integrals;
  integrals.reserve(leaves_.size());
  for (std::size_t i = 0; i < leaves_.size(); ++i)
    integrals.push_back(integral(leaves_[i], density, members[i]));
  return integrals;
}

}  // namespace abbe

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
// A cell without directions may still hold density: none is larger than this [sr].
constexpr double kLargestCell = 4 * std::numbers::pi / 128;
// Narrower than directions in float can be told apart.
constexpr double kLeastDepth = 1e-13;

}  // namespace

SphereCells::SphereCells(std::span<const Imath::V3f> directions, std::size_t most_per_cell) : nodes_(2) {
  std::array<std::vector<Place>, 2> held;
  for (const Imath::V3f& w : directions) {
    const Place p = place(w);
    held[p.above ? 1 : 0].push_back(p);
  }
  for (std::size_t above : {0U, 1U})
    build(above, {above == 1, 0, 1, 0, kTwoPi}, std::move(held[above]), most_per_cell);
}

SphereCells::Place SphereCells::place(const Imath::V3f& w) {
  const Imath::V3d v(w);
  const double phi = std::atan2(v.y, v.x);
  return {w.z > 0, (v.x * v.x + v.y * v.y) / (1 + std::abs(v.z)), phi < 0 ? phi + kTwoPi : phi};
}

Imath::V3f SphereCells::at(bool above, double depth, double phi) {
  const double sine = std::sqrt(depth * (2 - depth));
  return Imath::V3f(Imath::V3d(sine * std::cos(phi), sine * std::sin(phi), above ? 1 - depth : depth - 1));
}

void SphereCells::build(std::size_t node, const Cell& cell, std::vector<Place> held, std::size_t most) {
  const double height = cell.depth_high - cell.depth_low;
  const double width = cell.phi_high - cell.phi_low;
  if ((held.size() <= most && height * width <= kLargestCell) || height < kLeastDepth) {
    nodes_[node].leaf = leaves_.size();
    leaves_.push_back(cell);
    return;
  }
  const double depth = (cell.depth_low + cell.depth_high) / 2;
  const double phi = (cell.phi_low + cell.phi_high) / 2;
  const double sine = std::sqrt(depth * (2 - depth));
  const bool by_depth = height / sine > width * sine;  // angles along both sides
  const auto middle = std::partition(
      held.begin(), held.end(), [&](const Place& p) { return by_depth ? p.depth < depth : p.phi < phi; });
  std::vector<Place> second(middle, held.end());
  held.erase(middle, held.end());
  const std::size_t first_child = nodes_.size();
  nodes_[node] = {first_child, 0, by_depth, by_depth ? depth : phi};
  nodes_.resize(first_child + 2);
  Cell low = cell;
  Cell high = cell;
  (by_depth ? low.depth_high : low.phi_high) = nodes_[node].at;
  (by_depth ? high.depth_low : high.phi_low) = nodes_[node].at;
  build(first_child, low, std::move(held), most);
  build(first_child + 1, high, std::move(second), most);
}

std::size_t SphereCells::of(const Imath::V3f& w) const {
  const Place p = place(w);
  std::size_t node = p.above ? 1 : 0;
  while (nodes_[node].first_child != 0) {
    const double value = nodes_[node].by_depth ? p.depth : p.phi;
    node = nodes_[node].first_child + (value < nodes_[node].at ? 0 : 1);
  }
  return nodes_[node].leaf;
}

// Halved both ways until that makes no difference: a cell may hold the edge of a lobe, or one too narrow for
// samples to have found it.
double SphereCells::integral(const Cell& cell, const SphereDensity& density) {
  constexpr double kTolerance = 1e-6;  // of the whole
  constexpr int kHalvings = 10;
  return refined(cell, density, by_rule(cell, density), kTolerance, kHalvings);
}

double SphereCells::by_rule(const Cell& cell, const SphereDensity& density) {
  using Rule = boost::math::quadrature::gauss<double, 5>;
  const auto along_phi = [&](double depth) {
    return Rule::integrate([&](double phi) { return density(at(cell.above, depth, phi)); }, cell.phi_low,
                           cell.phi_high);
  };
  return Rule::integrate(along_phi, cell.depth_low, cell.depth_high);
}

double SphereCells::refined(const Cell& cell, const SphereDensity& density, double whole, double tolerance,
                            int halvings) {
  const double depth = (cell.depth_low + cell.depth_high) / 2;
  const double phi = (cell.phi_low + cell.phi_high) / 2;
  const std::array<Cell, 4> quarters{{{cell.above, cell.depth_low, depth, cell.phi_low, phi},
                                      {cell.above, cell.depth_low, depth, phi, cell.phi_high},
                                      {cell.above, depth, cell.depth_high, cell.phi_low, phi},
                                      {cell.above, depth, cell.depth_high, phi, cell.phi_high}}};
  std::array<double, 4> parts{};
  for (std::size_t i = 0; i < 4; ++i) parts[i] = by_rule(quarters[i], density);
  const double sum = parts[0] + parts[1] + parts[2] + parts[3];
  if (halvings == 0 || std::abs(sum - whole) < tolerance) return sum;
  double total = 0;
  for (std::size_t i = 0; i < 4; ++i)
    total += refined(quarters[i], density, parts[i], tolerance / 2, halvings - 1);
  return total;
}

std::vector<double> SphereCells::integrate(const SphereDensity& density) const {
  std::vector<double> integrals;
  integrals.reserve(leaves_.size());
  for (const Cell& cell : leaves_) integrals.push_back(integral(cell, density));
  return integrals;
}

}  // namespace abbe

#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <ImathVec.h>

namespace abbe {

/// Something per solid angle.
using SphereDensity = std::function<double(const Imath::V3f& w)>;

/// Cells that cover the sphere, fine where directions are many, so that a lobe as narrow as a needle still
/// fills many of them. They are rectangles in azimuth and distance to the nearer pole, 1 - |z|, halved along
/// their longer side; none crosses the horizon.
class SphereCells {
 public:
  /// Halved until none holds more than `most_per_cell` of `directions`.
  SphereCells(std::span<const Imath::V3f> directions, std::size_t most_per_cell);

  [[nodiscard]] std::size_t count() const { return leaves_.size(); }
  [[nodiscard]] std::size_t of(const Imath::V3f& w) const;
  /// Integral of `density` over each cell, by Gauss-Legendre quadrature of as small parts as it takes.
  [[nodiscard]] std::vector<double> integrate(const SphereDensity& density) const;

 private:
  /// Where a direction is: `depth` = 1 - |z|, kept exact near the poles.
  struct Place {
    bool above;
    double depth, phi;
  };
  struct Cell {
    bool above;
    double depth_low, depth_high;
    double phi_low, phi_high;
  };
  struct Node {
    std::size_t first_child = 0;  // the second follows it; 0 for a leaf
    std::size_t leaf = 0;
    bool by_depth = false;
    double at = 0;
  };

  static Place place(const Imath::V3f& w);
  static Imath::V3f at(bool above, double depth, double phi);
  static double integral(const Cell& cell, const SphereDensity& density);
  static double by_rule(const Cell& cell, const SphereDensity& density);
  static double refined(const Cell& cell, const SphereDensity& density, double whole, double tolerance,
                        int halvings);
  void build(std::size_t node, const Cell& cell, std::vector<Place> held, std::size_t most);

  std::vector<Node> nodes_;
  std::vector<Cell> leaves_;
};

}  // namespace abbe

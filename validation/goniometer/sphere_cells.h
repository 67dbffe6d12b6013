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
  /// Integral of `density` over each cell, by Gauss-Legendre quadrature of as small parts as it takes. It may
  /// have lobes and edges that none of the nodes meets: what it is along the directions `found` tells of
  /// them.
  [[nodiscard]] std::vector<double> integrate(const SphereDensity& density,
                                              std::span<const Imath::V3f> found = {}) const;

 private:
  /// Where a direction is: `depth` = 1 - |z|, kept exact near the poles.
  struct Place {
    bool above;
    double depth, phi;
  };
  struct Found {
    Place place;
    double density;
  };
  /// What a rule makes of a cell, and the largest density that its nodes have met.
  struct RuleSum {
    double integral, most;
  };
  struct Cell {
    bool above;
    double depth_low, depth_high;
    double phi_low, phi_high;
  };
  /// A cell halved along its longer side.
  struct Halves {
    bool by_depth;
    double at;
    Cell low, high;

    [[nodiscard]] bool in_low(const Place& p) const { return (by_depth ? p.depth : p.phi) < at; }
  };
  struct Node {
    std::size_t first_child = 0;  // the second follows it; 0 for a leaf
    std::size_t leaf = 0;
    bool by_depth = false;
    double at = 0;
  };

  static Place place(const Imath::V3f& w);
  [[nodiscard]] std::size_t of(const Place& p) const;
  static Imath::V3f at(bool above, double depth, double phi);
  static Halves halved(const Cell& cell);
  static double integral(const Cell& cell, const SphereDensity& density, std::span<Found> found);
  static RuleSum by_rule(const Cell& cell, const SphereDensity& density);
  static double refined(const Cell& cell, const SphereDensity& density, double whole, double tolerance,
                        int quarterings);
  void build(std::size_t node, const Cell& cell, std::vector<Place> held, std::size_t most);

  std::vector<Node> nodes_;
  std::vector<Cell> leaves_;
};

}  // namespace abbe

#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <ImathVec.h>

namespace abbe {

/// Density [1/sr] as a function of a unit direction.
using SphereDensity = std::function<double(const Imath::V3f& w)>;

/// Partition of the sphere that is fine where directions are dense, so that even a very narrow lobe covers
/// many cells. A cell is a rectangle in azimuth and in 1 - |z|, the depth below the nearer pole. Cells are
/// halved along their longer side; none crosses the horizon.
class SphereCells {
 public:
  /// Halves cells until none contains more than `max_per_cell` of the unit `directions` or exceeds 4 pi/128
  /// sr. Cells with a depth below 1e-13 are not halved, and may contain more.
  SphereCells(std::span<const Imath::V3f> directions, std::size_t max_per_cell);

  [[nodiscard]] std::size_t count() const { return leaves_.size(); }
  /// Index in [0, `count()`) of the cell that contains the unit direction `w`.
  [[nodiscard]] std::size_t cell_of(const Imath::V3f& w) const;
  /// Integral of `density` over each cell, by index, by adaptive Gauss-Legendre quadrature. The density may
  /// have lobes and edges that no quadrature node hits. Cells that contain such features are refined around
  /// the given `directions`.
  [[nodiscard]] std::vector<double> integrate(const SphereDensity& density,
                                              std::span<const Imath::V3f> directions = {}) const;

 private:
  /// A direction in polar coordinates: `depth` = 1 - |z| without cancellation near the poles, and azimuth
  /// `phi`.
  struct PolarPoint {
    bool above;
    double depth, phi;
  };
  struct KnownDensity {
    PolarPoint point;
    double density;
  };
  /// Result of a quadrature rule for a cell, and the largest density at its nodes.
  struct RuleSum {
    double integral, max_density;
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

    [[nodiscard]] bool in_low(const PolarPoint& p) const { return (by_depth ? p.depth : p.phi) < at; }
  };
  struct Node {
    std::size_t first_child = 0;  // The second child follows the first; 0 for a leaf.
    std::size_t leaf = 0;
    bool by_depth = false;
    double at = 0;
  };

  static PolarPoint to_polar(const Imath::V3f& w);
  [[nodiscard]] std::size_t cell_of(const PolarPoint& p) const;
  static Imath::V3f at(bool above, double depth, double phi);
  static Halves halved(const Cell& cell);
  static double integral(const Cell& cell, const SphereDensity& density, std::span<KnownDensity> known);
  static RuleSum by_rule(const Cell& cell, const SphereDensity& density);
  static double refined(const Cell& cell, const SphereDensity& density, double whole, double tolerance,
                        int quarterings);
  void build(std::size_t node, const Cell& cell, std::vector<PolarPoint> members, std::size_t max_per_cell);

  std::vector<Node> nodes_;
  std::vector<Cell> leaves_;
};

}  // namespace abbe

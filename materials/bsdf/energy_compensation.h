#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "materials/interface/microfacet.h"

namespace abbe {

/// Table of the energy 1 - E(w) that single scattering by a rough surface loses, for unit vectors w above the
/// surface. Multiply scattered light leaves in proportion to it, which preserves reciprocity and conserves
/// energy. [Kelemen2001] [Kulla2017]
class EnergyCompensation {
 public:
  /// Coordinates of a direction in all tables of the same facets. The tilt runs from the horizon to the
  /// normal, the turn from the azimuth of x to that of y.
  struct TableCoordinates {
    int tilt_cell, turn_cell;  ///< Cells of tilt and turn, counted from 0.
    float tilt, turn;          ///< Position within the cell, in [0, 1].
    int density_cell;          ///< Cell of the tabulated pdf of `sample`.
  };
  /// Table coordinates of a direction, on either side of the surface.
  [[nodiscard]] static TableCoordinates table_coordinates(const Microfacets<float>& facets,
                                                          const Imath::V3f& w);

  /// Writes the energies E(w), w.z > 0, into `energies`, one for each table.
  using Energies = std::function<void(const Imath::V3f& w, std::span<double> energies)>;
  /// Makes `count` tables, one for each of the energies.
  [[nodiscard]] static std::vector<EnergyCompensation> tabulate(const Microfacets<float>& facets,
                                                                std::size_t count, const Energies& energies);

  /// 1 - E, in [0, 1), interpolated between the tabulated directions.
  [[nodiscard]] float at(const TableCoordinates& coordinates) const;
  /// Integral of 1 - E over projected solid angle [sr], positive.
  [[nodiscard]] float total() const { return total_; }
  /// Samples a direction w, w.z > 0, approximately in proportion to (1 - E) w.z. `u` is in [0, 1)^2.
  [[nodiscard]] Imath::V3f sample(const Imath::V2f& u) const;
  /// Pdf of `sample` [1/sr]; `cos` is |w.z|.
  [[nodiscard]] float pdf(const TableCoordinates& coordinates, float cos) const;

 private:
  static constexpr int kTilts = 33;
  static constexpr int kTurns = 17;  // azimuths in a quarter turn
  static constexpr int kCells = kTilts - 1;

  void prepare_density(const Microfacets<float>& facets);

  std::array<std::array<float, kTurns>, kTilts> lost_{};
  float total_ = 0;
  // Mean over azimuths in cells of the squared cosine, from the horizon up, with one density per projected
  // solid angle in each cell. The cells are narrower than those of the table, within which 1 - E varies by
  // large factors.
  static constexpr int kDensityCells = 8 * kCells;
  std::array<float, kDensityCells + 1> cos2_{};
  std::array<float, kDensityCells + 1> cumulative_{};
  std::array<float, kDensityCells> density_{};
};

/// E for perfectly reflecting facets, w.z > 0. [Heitz2014, eq. 99]
[[nodiscard]] double mirror_energy(const Microfacets<float>& facets, const Imath::V3f& w);
/// E of a dielectric interface by reflection and transmission together, w.z > 0. `energies` receives one
/// value for each relative index n_t/n_i in `etas`, with w on the side of n_i. [Walter2007, eq. 20 and 21]
void dielectric_energies(const Microfacets<float>& facets, const Imath::V3f& w, std::span<const float> etas,
                         std::span<double> energies);

}  // namespace abbe

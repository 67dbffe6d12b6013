#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "materials/interface/microfacet.h"

namespace abbe {

/// What light that a rough surface has scattered once does not leave with: the share 1 - E(w) of each
/// direction w above the surface, by a table. Light scattered more often leaves in proportion to it, which
/// keeps both reciprocity and energy. [Kelemen2001] [Kulla2017]
class EnergyCompensation {
 public:
  /// A direction's place in all tables of the same facets.
  struct Place {
    int tilt_cell, turn_cell;
    float tilt, turn;  ///< Between the ends of those cells.
    int density_cell;
  };
  [[nodiscard]] static Place place(const Microfacets<float>& facets, const Imath::V3f& w);

  /// Writes E(w) of some light or other, w.z > 0, into its second argument.
  using Energies = std::function<void(const Imath::V3f& w, std::span<double> energies)>;
  /// Makes `count` tables, one for each of the energies, from their values for a few hundred directions.
  [[nodiscard]] static std::vector<EnergyCompensation> tabulate(const Microfacets<float>& facets,
                                                                std::size_t count, const Energies& energies);

  /// 1 - E, in [0, 1).
  [[nodiscard]] float at(const Place& place) const;
  /// The integral of the table over projected solid angle [sr], positive.
  [[nodiscard]] float total() const { return total_; }
  /// A direction w, w.z > 0, drawn nearly in proportion to (1 - E) w.z, and the density of that [1/sr].
  [[nodiscard]] Imath::V3f sample(const Imath::V2f& u) const;
  [[nodiscard]] float pdf(const Place& place, float cos) const;  ///< At a direction of that cosine.

 private:
  static constexpr int kTilts = 33;
  static constexpr int kTurns = 17;  // of a quarter turn
  static constexpr int kCells = kTilts - 1;

  void prepare_density(const Microfacets<float>& facets);

  std::array<std::array<float, kTurns>, kTilts> lost_{};
  float total_ = 0;
  // The mean over azimuths in cells of squared cosine, from the horizon up, each of one density over
  // projected solid angle. They are narrower than those of the table, within which 1 - E varies manyfold.
  static constexpr int kDensityCells = 8 * kCells;
  std::array<float, kDensityCells + 1> cos2_{};
  std::array<float, kDensityCells + 1> cumulative_{};
  std::array<float, kDensityCells> density_{};
};

/// E for perfectly reflecting facets. [Heitz2014, eq. 99]
[[nodiscard]] double mirror_energy(const Microfacets<float>& facets, const Imath::V3f& w);
/// E for the boundary to matter of each relative index, reflection and transmission together.
/// [Walter2007, eq. 20 and 21]
void dielectric_energies(const Microfacets<float>& facets, const Imath::V3f& w, std::span<const float> etas,
                         std::span<double> energies);

}  // namespace abbe

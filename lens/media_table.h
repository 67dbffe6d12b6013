#pragma once

#include <array>
#include <type_traits>
#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// Index and absorption of the media before the first surface and behind each surface of a lens, tabulated
/// every nanometre. Linear interpolation is accurate to about 1e-7 for the index. Medium 0 is the air before
/// the first surface; medium i + 1 is behind surface i.
class MediaTable {
 public:
  /// Tabulates the media from 300 to 1100 nm. `system` need not outlive the table.
  explicit MediaTable(const System& system);

  /// Position of one wavelength, or of each lane, in the table.
  template <typename Real>
  struct Coordinate {
    std::array<const double*, sizeof(Real) / sizeof(ScalarOf<Real>)> row;
    Real fraction;  ///< Position between this row and the next, in [0, 1].
  };
  /// Table position of a wavelength [nm], clamped to [300, 1100]. Valid as long as the table.
  template <typename Real>
  [[nodiscard]] Coordinate<Real> coordinate(const Real& wavelength_nm) const;

  /// Refractive index relative to air.
  template <typename Real>
  [[nodiscard]] Real n(std::size_t medium, const Coordinate<Real>& coordinate) const {
    return at(medium, coordinate);
  }
  /// True if the medium absorbs at any wavelength of the table.
  [[nodiscard]] bool absorbs(std::size_t medium) const { return absorbs_[medium]; }
  /// Absorption coefficient a of power [1/mm]: e^(-a d) is transmitted over a distance d.
  template <typename Real>
  [[nodiscard]] Real absorption_per_mm(std::size_t medium, const Coordinate<Real>& coordinate) const {
    return at(absorbs_.size() + medium, coordinate);
  }

 private:
  template <typename Real>
  [[nodiscard]] Real at(std::size_t column, const Coordinate<Real>& coordinate) const {
    const auto value = [&](std::size_t of) {
      return by_lane<Real>([&](int j) { return coordinate.row[static_cast<std::size_t>(j)][of]; });
    };
    const Real here = value(column);
    return here + coordinate.fraction * (value(column + columns()) - here);
  }
  [[nodiscard]] std::size_t columns() const { return 2 * absorbs_.size(); }

  std::vector<bool> absorbs_;   // at any wavelength
  std::vector<double> values_;  // row by row: indices, then absorptions
};

}  // namespace abbe::lens

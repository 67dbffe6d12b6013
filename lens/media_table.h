#pragma once

#include <array>
#include <type_traits>
#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// Index and absorption of the media before the first surface and behind each surface of a lens, tabulated
/// every nanometre. Linear interpolation is accurate to about 1e-7 for the index.
class MediaTable {
 public:
  explicit MediaTable(const System& system);

  /// Position of one wavelength, or of each lane, in the table.
  template <typename Real>
  struct Coordinate {
    std::array<const double*, sizeof(Real) / sizeof(ScalarOf<Real>)> row;
    Real fraction;  ///< Position between this row and the next, in [0, 1].
  };
  /// Table position of a wavelength, clamped to the range of the table.
  template <typename Real>
  [[nodiscard]] Coordinate<Real> coordinate(const Real& wavelength_nm) const;

  /// Refractive index relative to air.
  template <typename Real>
  [[nodiscard]] Real n(std::size_t medium, const Coordinate<Real>& coordinate) const {
    return at(medium, coordinate);
  }
  [[nodiscard]] bool absorbs(std::size_t medium) const { return absorbs_[medium]; }
  /// Absorption of power.
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

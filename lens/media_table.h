#pragma once

#include <array>
#include <type_traits>
#include <vector>

#include "lens/system.h"

namespace abbe::lens {

/// Index and absorption of what lies before the first surface of a lens and behind each, in tables every
/// nanometre, between which they are taken for linear: the index to 1e-7 or so.
class MediaTable {
 public:
  explicit MediaTable(const System& system);

  /// A wavelength in the tables, or one for each lane.
  template <typename Real>
  struct Place {
    std::array<const double*, sizeof(Real) / sizeof(ScalarOf<Real>)> row;
    Real share;  ///< Of the way to the next row.
  };
  /// Wavelengths beyond the tables are those of their ends.
  template <typename Real>
  [[nodiscard]] Place<Real> place(const Real& wavelength_nm) const;

  /// Relative to air.
  template <typename Real>
  [[nodiscard]] Real n(std::size_t medium, const Place<Real>& place) const {
    return at(medium, place);
  }
  [[nodiscard]] bool absorbs(std::size_t medium) const { return absorbs_[medium]; }
  /// Of power.
  template <typename Real>
  [[nodiscard]] Real absorption_per_mm(std::size_t medium, const Place<Real>& place) const {
    return at(absorbs_.size() + medium, place);
  }

 private:
  template <typename Real>
  [[nodiscard]] Real at(std::size_t column, const Place<Real>& place) const {
    const auto value = [&](std::size_t of) {
      return by_lane<Real>([&](int j) { return place.row[static_cast<std::size_t>(j)][of]; });
    };
    const Real here = value(column);
    return here + place.share * (value(column + columns()) - here);
  }
  [[nodiscard]] std::size_t columns() const { return 2 * absorbs_.size(); }

  std::vector<bool> absorbs_;   // anywhere
  std::vector<double> values_;  // row by row: indices, then absorptions
};

}  // namespace abbe::lens

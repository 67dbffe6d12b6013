#include "lens/media_table.h"

#include <algorithm>

#include "spectral/curve.h"

namespace abbe::lens {
namespace {

constexpr int kTableCells = kMaxWavelengthNm - kMinWavelengthNm;

}  // namespace

MediaTable::MediaTable(const System& system) : absorbs_(system.surfaces.size() + 1) {
  values_.assign(columns() * (kTableCells + 1), 0);
  for (int i = 0; i <= kTableCells; ++i) {
    const double nm = kMinWavelengthNm + i;
    double* row = &values_[columns() * static_cast<std::size_t>(i)];
    row[0] = 1;
    for (std::size_t medium = 1; medium < absorbs_.size(); ++medium) {
      const auto& glass = system.surfaces[medium - 1].behind;
      row[medium] = glass ? glass->index.n(nm) : 1;
      if (!glass) continue;
      const double absorption_per_mm = glass->index.absorption_per_m(nm) / kMmPerM;
      row[absorbs_.size() + medium] = absorption_per_mm;
      if (absorption_per_mm != 0) absorbs_[medium] = true;
    }
  }
}

template <typename Real>
MediaTable::Coordinate<Real> MediaTable::coordinate(const Real& wavelength_nm) const {
  Coordinate<Real> coordinate;
  coordinate.fraction = by_lane<Real>([&](int j) {
    const double x = std::clamp(static_cast<double>(lane_of(wavelength_nm, j)) - kMinWavelengthNm, 0.0,
                                double{kTableCells});
    const int cell = std::min(static_cast<int>(x), kTableCells - 1);
    coordinate.row[static_cast<std::size_t>(j)] = &values_[columns() * static_cast<std::size_t>(cell)];
    return x - cell;
  });
  return coordinate;
}

template MediaTable::Coordinate<double> MediaTable::coordinate(const double&) const;
template MediaTable::Coordinate<Doubles> MediaTable::coordinate(const Doubles&) const;
template MediaTable::Coordinate<Floats> MediaTable::coordinate(const Floats&) const;

}  // namespace abbe::lens
